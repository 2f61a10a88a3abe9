#include "pipeline/driver/estimate.h"

#include <fmt/format.h>

#include <algorithm>

#include "base/files/memory_limit.h"
#include "base/programs/capture_size.h"
#include "base/programs/run_progress.h"
#include "base/stages/stages.h"

namespace glint {

double CaptureEstimate::seconds() const {
  double sum = 0;
  for (const StageEstimate& stage : stages) sum += stage.seconds;
  return sum;
}

double CaptureEstimate::memory_bytes() const {
  double most = 0;
  for (const StageEstimate& stage : stages) most = std::max(most, stage.memory_bytes);
  return most;
}

std::string CaptureEstimate::ToText() const {
  const auto line = [](const std::string& name, double seconds, double memory_bytes) {
    return fmt::format("{:<9} {:>9} {:>9}\n", name, DurationText(seconds),
                       MemoryText(memory_bytes));
  };
  std::string text;
  for (const StageEstimate& stage : stages) {
    text += line(stage.step.stage, stage.seconds, stage.memory_bytes);
  }
  return text + line("all", seconds(), memory_bytes()) +
         "on two cores of a 2.8 GHz Xeon; on another machine all times change by about the same "
         "factor\n";
}

Json CaptureEstimate::ToJson() const {
  Json list = Json::array();
  for (const StageEstimate& stage : stages) {
    list.push_back({{"stage", stage.step.stage},
                    {"arguments", stage.step.arguments},
                    {"inputs", stage.step.inputs},
                    {"waits_for", stage.step.waits_for},
                    {"manifest", stage.step.manifest},
                    {"by_parts", FindStage(stage.step.stage)->by_parts},
                    {"seconds", stage.seconds},
                    {"memory_bytes", stage.memory_bytes}});
  }
  return {{"photographs", size.photographs},
          {"photograph_px", size.photograph_px},
          {"texels", size.texels},
          {"stages", list},
          {"seconds", seconds()},
          {"memory_bytes", memory_bytes()}};
}

CaptureEstimate EstimateCapture(const Capture& capture, const std::vector<StageStep>& steps,
                                int threads) {
  CaptureEstimate estimate;
  estimate.size = SizeOf(capture);
  for (const StageStep& step : steps) {
    estimate.stages.push_back({step, PredictedSeconds(step.cost, estimate.size),
                               PredictedMemory_bytes(step.cost, estimate.size, threads)});
  }
  return estimate;
}

}  // namespace glint
