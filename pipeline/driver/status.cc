#include "pipeline/driver/status.h"

#include <cstdio>
#include <map>
#include <sstream>

#include "base/errors/errors.h"
#include "base/formats/manifest.h"
#include "pipeline/driver/child_process.h"
#include "pipeline/driver/programs.h"

namespace glint {
namespace {

namespace fs = std::filesystem;
using State = StageStatus::State;

constexpr size_t kMaxMetricsShown = 5;

std::string StateName(State state) {
  switch (state) {
    case State::kUpToDate:
      return "up to date";
    case State::kStale:
      return "stale";
    case State::kMissing:
      break;
  }
  return "missing";
}

std::string SizeText(std::uintmax_t bytes) {
  if (bytes == 0) return "";
  char text[32];
  if (bytes < 1'000'000) {
    std::snprintf(text, sizeof(text), "%.1f kB", static_cast<double>(bytes) / 1e3);
  } else {
    std::snprintf(text, sizeof(text), "%.1f MB", static_cast<double>(bytes) / 1e6);
  }
  return text;
}

// The plain numbers among the metrics, as many as fit on a line.
std::string MetricsText(const Json& metrics) {
  std::ostringstream text;
  text.precision(4);
  size_t shown = 0;
  for (const auto& [name, value] : metrics.items()) {
    if (!value.is_number() || shown++ == kMaxMetricsShown) continue;
    if (shown > kMaxMetricsShown) break;
    text << (shown > 1 ? ", " : "") << name << " " << value.get<double>();
  }
  return text.str();
}

void AddResult(const fs::path& manifest_file, StageStatus* status) {
  try {
    const Manifest manifest = ReadManifest(manifest_file);
    status->metrics = manifest.metrics;
    std::error_code error;
    for (const ManifestOutput& output : manifest.outputs) {
      const auto bytes = fs::file_size(manifest_file.parent_path() / output.path, error);
      if (!error) status->bytes += bytes;
    }
  } catch (const UserError& error) {
    status->why = error.what();
  }
}

// What the stage's own program says of its result.
void AskProgram(const Capture& capture, const StageStep& step, StageStatus* status) {
  ChildProcess child;
  child.arguments = {RequireGlintProgram("glint-" + step.stage).string(), capture.folder.string()};
  child.arguments.insert(child.arguments.end(), step.arguments.begin(), step.arguments.end());
  child.arguments.insert(child.arguments.end(), step.kept.begin(), step.kept.end());
  child.arguments.insert(child.arguments.end(), {"--status", "--json", "--log-level", "off"});
  std::string text;
  child.on_line = [&text](const std::string& line) { text += line + "\n"; };
  const int code = RunChild(child);
  status->state = State::kStale;
  if (code != 0) {
    status->why = "glint-" + step.stage + " cannot run (see its message above)";
    return;
  }
  const Json answer = Json::parse(text, nullptr, false);
  if (!answer.is_object() || !answer.contains("up_to_date")) {
    status->why = "glint-" + step.stage + " does not answer --status";
    return;
  }
  if (answer["up_to_date"] == true) {
    status->state = State::kUpToDate;
  } else {
    status->why = answer.value("why_stale", "");
  }
}

StageStatus LookAtStep(const Capture& capture, const StageStep& step,
                       const std::map<std::string, State>& earlier) {
  StageStatus status;
  status.stage = step.stage;
  const fs::path manifest_file = capture.folder / step.manifest;
  const bool exists = fs::exists(manifest_file);
  if (exists) AddResult(manifest_file, &status);
  status.state = exists ? State::kStale : State::kMissing;
  if (!exists) status.why = "there is no result yet";
  if (!status.why.empty()) return status;
  for (const std::string& name : step.waits_for) {
    const auto found = earlier.find(name);
    if (found == earlier.end() || found->second == State::kUpToDate) continue;
    status.why = "it reads the result of " + name + ", which is " + StateName(found->second);
    return status;
  }
  AskProgram(capture, step, &status);
  return status;
}

}  // namespace

CaptureStatus LookAtCapture(const Capture& capture, const std::vector<StageStep>& steps) {
  CaptureStatus status;
  status.capture = capture.folder;
  std::map<std::string, State> states;
  for (const StageStep& step : steps) {
    status.stages.push_back(LookAtStep(capture, step, states));
    states[step.stage] = status.stages.back().state;
  }
  return status;
}

std::string CaptureStatus::BriefReport() const {
  std::string text;
  for (const StageStatus& stage : stages) {
    char line[64];
    std::snprintf(line, sizeof(line), "%-8s %-10s %9s  ", stage.stage.c_str(),
                  StateName(stage.state).c_str(), SizeText(stage.bytes).c_str());
    text += line + (stage.why.empty() ? MetricsText(stage.metrics) : stage.why) + "\n";
  }
  return text;
}

std::string CaptureStatus::Plan() const {
  std::string text;
  for (const StageStatus& stage : stages) {
    char line[64];
    const bool runs = stage.state != State::kUpToDate;
    std::snprintf(line, sizeof(line), "%-8s %-10s ", stage.stage.c_str(),
                  runs ? "would run" : "up to date");
    text += line + stage.why + "\n";
  }
  return text;
}

Json CaptureStatus::ToJson() const {
  Json list = Json::array();
  for (const StageStatus& stage : stages) {
    list.push_back({{"stage", stage.stage},
                    {"state", StateName(stage.state)},
                    {"why", stage.why},
                    {"bytes", stage.bytes},
                    {"metrics", stage.metrics}});
  }
  return {{"capture", capture.generic_string()}, {"stages", list}};
}

}  // namespace glint
