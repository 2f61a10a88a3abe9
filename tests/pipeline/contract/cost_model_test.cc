// What stages took on real machines against what the cost model says.
#include "pipeline/contract/cost_model.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "pipeline/contract/run_progress.h"

namespace glint {
namespace {

struct Measured {
  const char* stage;
  double seconds, peak_memory_mb;
};

struct MeasuredRun {
  CaptureSize size;
  std::vector<Measured> stages;
};

constexpr double kMega = 1e6;

// Two cores of a Xeon with AVX-512 and without bfloat16; `glint run`, run.json of each stage.
// Memory as it is since stages work by rows.
std::vector<MeasuredRun> Runs() {
  const auto size = [](int photographs, double megapixels, int side) {
    return CaptureSize{photographs, kMega * megapixels, 1.0 * side * side, false};
  };
  return {
      {size(5, 12, 256),
       {{"calib", 5.45, 552},
        {"rectify", 2.11, 357},
        {"fit", 30.6, 364},
        {"refine", 4.49, 159},
        {"export", 1.42, 150},
        {"report", 2.58, 277}}},
      {size(12, 12, 512),
       {{"calib", 11.5, 570},
        {"rectify", 5.95, 354},
        {"fit", 22.3, 376},
        {"refine", 9.91, 240},
        {"export", 2.52, 204},
        {"report", 4.22, 304}}},
      {size(9, 2, 1024),
       {{"calib", 4.37, 239},
        {"rectify", 7.09, 222},
        {"fit", 24.0, 357},
        {"refine", 36.1, 499},
        {"export", 10.2, 382},
        {"report", 14.5, 390}}},
      {size(12, 12, 1024),
       {{"calib", 9.73, 569},
        {"rectify", 9.74, 366},
        {"fit", 26.2, 374},
        {"refine", 36.5, 546},
        {"export", 10.5, 387},
        {"report", 11.2, 396}}},
      {size(12, 12, 2048),
       {{"calib", 10.3, 568},
        {"rectify", 34.31, 383},
        {"fit", 32.93, 446},
        {"refine", 102.83, 1128},
        {"export", 33.52, 775},
        {"report", 36.92, 693}}},
  };
}

constexpr double kFactor = 1.5;

bool Within(double a, double b) { return std::max(a, b) <= kFactor * std::min(a, b); }

TEST(CostModel, MemoryOfEveryStageIsWithinOneAndAHalf) {
  for (const MeasuredRun& run : Runs()) {
    for (const Measured& stage : run.stages) {
      const double mb = PredictedMemory_bytes(stage.stage, run.size, 2) / kMega;
      EXPECT_TRUE(Within(mb, stage.peak_memory_mb))
          << stage.stage << " of " << run.size.texels << " texels: " << mb << " MB predicted, "
          << stage.peak_memory_mb << " MB measured";
    }
  }
}

TEST(CostModel, SecondsOfRunsAndOfEveryStageAreWithinOneAndAHalf) {
  for (const MeasuredRun& run : Runs()) {
    double predicted = 0, measured = 0;
    for (const Measured& stage : run.stages) {
      predicted += PredictedSeconds(stage.stage, run.size);
      measured += stage.seconds;
    }
    EXPECT_TRUE(Within(predicted, measured)) << predicted << " s, measured " << measured << " s";
    for (const Measured& stage : run.stages) {
      const double seconds = PredictedSeconds(stage.stage, run.size);
      EXPECT_TRUE(Within(seconds, stage.seconds))
          << stage.stage << " of " << run.size.texels << " texels: " << seconds << " s, measured "
          << stage.seconds << " s";
    }
  }
}

// A machine of half the speed makes no difference: what a run has taken so far shows it.
TEST(CostModel, TheTimeLeftIsWithinOneAndAHalfFromAFifthOfTheRunOn) {
  for (const MeasuredRun& run : Runs()) {
    for (const double slower : {1.0, 2.0}) {
      double all = 0, before = 0, predicted_before = 0, predicted_all = 0;
      for (const Measured& stage : run.stages) {
        all += slower * stage.seconds;
        predicted_all += PredictedSeconds(stage.stage, run.size);
      }
      for (const Measured& stage : run.stages) {
        const double own = PredictedSeconds(stage.stage, run.size);
        const RunProgress progress{0, predicted_before, own,
                                   predicted_all - predicted_before - own};
        for (const double share : {0.0, 0.3, 0.6, 0.9}) {
          const double now = before + slower * share * stage.seconds;
          const double left = all - now;
          if (now < 0.2 * all) continue;
          const auto said = progress.Remaining_s(share, now);
          ASSERT_TRUE(said.has_value());
          EXPECT_TRUE(Within(*said, left))
              << stage.stage << " " << share << " of " << run.size.texels << " texels: " << *said
              << " s said, " << left << " s left";
        }
        before += slower * stage.seconds;
        predicted_before += own;
      }
    }
  }
}

}  // namespace
}  // namespace glint
