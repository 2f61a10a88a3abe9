#include "pipeline/overview/capture_summary.h"

#include <algorithm>
#include <fstream>
#include <sstream>

#include "base/errors/errors.h"
#include "base/files/hash.h"
#include "base/files/json_file.h"
#include "base/formats/capture.h"
#include "base/formats/manifest.h"
#include "base/formats/rectified_set.h"
#include "pipeline/driver/ninja_file.h"
#include "pipeline/driver/stage_graph.h"

namespace glint {
namespace {

namespace fs = std::filesystem;
using State = CaptureSummary::State;

constexpr std::uintmax_t kMostThumbnail_bytes = 1 << 20;

std::string TextOf(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  std::ostringstream text;
  text << stream.rdbuf();
  return text.str();
}

// From the program's error to the end; without one (killed, say) the last line. What comes before
// is progress.
std::string ErrorIn(const std::string& log) {
  std::istringstream lines(log);
  std::string error, last;
  for (std::string line; std::getline(lines, line);) {
    if (line.find_first_not_of(" \t\r") == std::string::npos) continue;
    last = line;
    if (line.find(": error: ") != std::string::npos) {
      error = line;
    } else if (!error.empty()) {
      error += "\n" + line;
    }
  }
  return error.empty() ? last : error;
}

std::optional<double> NumberAt(const Json& json, const std::string& pointer) {
  const Json::json_pointer at(pointer);
  if (!json.contains(at) || !json[at].is_number()) return std::nullopt;
  return json[at].get<double>();
}

Json JsonIn(const fs::path& file) {
  std::error_code error;
  if (!fs::is_regular_file(file, error)) return Json::object();
  const Json json = ReadJsonFile(file, "run glint run again");
  return json.is_object() ? json : Json::object();
}

// The first stage that has no result, or one made from another stage's earlier result.
void FindState(const Capture& capture, const std::vector<StageStep>& steps,
               CaptureSummary* summary) {
  summary->state = State::kDone;
  for (const StageStep& step : steps) {
    summary->stage = step.stage;
    const fs::path failure = capture.folder / FailureFile(step.stage);
    if (fs::is_regular_file(failure)) {
      summary->state = State::kFailed;
      summary->message = ErrorIn(TextOf(failure));
      return;
    }
    const fs::path file = capture.folder / step.manifest;
    if (!fs::exists(file)) {
      summary->state = State::kUnfinished;
      return;
    }
    const Manifest manifest = ReadManifest(file, step.stage);
    for (const ManifestInput& input : manifest.inputs) {
      const fs::path read = (file.parent_path() / input.path).lexically_normal();
      if (read.filename() != "manifest.json") continue;
      if (fs::exists(read) && HashFile(read) == input.hash) continue;
      summary->state = State::kOutOfDate;
      return;
    }
  }
  summary->stage.clear();
}

void AddFigures(const Capture& capture, const std::vector<StageStep>& steps,
                CaptureSummary* summary) {
  const fs::path work = capture.work();
  const Json calib = JsonIn(work / "calib" / "manifest.json");
  const Json::json_pointer verdict("/metrics/guidance/verdict");
  if (calib.contains(verdict) && calib[verdict].is_string()) summary->verdict = calib[verdict];
  summary->reprojection_px = NumberAt(calib, "/metrics/rms_px");
  const Json views = JsonIn(ViewsManifest(work));
  summary->texels_across = NumberAt(views, "/data/width");
  summary->texels_down = NumberAt(views, "/data/height");
  summary->width_mm = NumberAt(views, "/data/width_mm");
  summary->height_mm = NumberAt(views, "/data/height_mm");
  const Json report = JsonIn(work / "report" / "manifest.json");
  summary->photographs = NumberAt(report, "/metrics/fitted/photographs");
  summary->log_l1 = NumberAt(report, "/metrics/fitted/log_l1");
  summary->held_out_log_l1 = NumberAt(report, "/metrics/held_out/log_l1");
  for (const StageStep& step : steps) {
    const Json run = JsonIn(work / step.stage / "run.json");
    if (const auto seconds = NumberAt(run, "/seconds")) {
      summary->seconds = summary->seconds.value_or(0) + *seconds;
    }
  }
  std::error_code error;
  const fs::path page = work / "report" / "index.html", picture = work / "report" / "thumbnail.jpg";
  if (fs::is_regular_file(page, error)) summary->page = page;
  if (fs::is_regular_file(picture, error) && fs::file_size(picture) <= kMostThumbnail_bytes) {
    summary->thumbnail_jpeg = TextOf(picture);
  }
}

}  // namespace

std::string ToText(State state) {
  switch (state) {
    case State::kFailed:
      return "failed";
    case State::kUnfinished:
      return "unfinished";
    case State::kOutOfDate:
      return "out of date";
    case State::kDone:
      return "done";
  }
  return "";
}

fs::path FailureFile(const std::string& stage) {
  return fs::path("glint") / "workflow" / (stage + ".failed");
}

CaptureSummary SummariseCapture(const fs::path& folder) {
  CaptureSummary summary;
  summary.folder = folder;
  summary.name = fs::absolute(folder).lexically_normal().filename().string();
  if (summary.name.empty()) {
    summary.name = fs::absolute(folder).lexically_normal().parent_path().filename().string();
  }
  try {
    const Capture capture = ReadCapture(folder);
    const auto steps = StageSteps(capture, ReadChoices(capture.work() / "build.ninja"));
    AddFigures(capture, steps, &summary);
    FindState(capture, steps, &summary);
  } catch (const Error& error) {
    summary.state = State::kFailed;
    summary.message = error.what();
  }
  return summary;
}

Json ToJson(const CaptureSummary& summary) {
  Json json = {{"capture", summary.folder.generic_string()},
               {"name", summary.name},
               {"state", ToText(summary.state)},
               {"stage", summary.stage},
               {"message", summary.message},
               {"verdict", summary.verdict}};
  const auto add = [&](const char* name, const std::optional<double>& value) {
    json[name] = value ? Json(*value) : Json();
  };
  add("photographs", summary.photographs);
  add("reprojection_px", summary.reprojection_px);
  add("log_l1", summary.log_l1);
  add("held_out_log_l1", summary.held_out_log_l1);
  add("seconds", summary.seconds);
  return json;
}

}  // namespace glint
