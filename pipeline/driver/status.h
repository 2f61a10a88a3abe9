// `glint status` and `glint run --dry-run`: what is up to date, what is not and why.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "base/files/json.h"
#include "pipeline/driver/stage_graph.h"

namespace glint {

struct StageStatus {
  enum class State { kUpToDate, kStale, kMissing };
  std::string stage;
  State state = State::kMissing;
  std::string why;                // of a stale or missing result
  std::uintmax_t bytes = 0;       // of the result's files
  Json metrics = Json::object();  // of its manifest
};

struct CaptureStatus {
  std::filesystem::path capture;
  std::vector<StageStatus> stages;

  std::string BriefReport() const;
  // What `glint run` would do.
  std::string Plan() const;
  Json ToJson() const;
};

// Asks each stage's program (glint-<stage> --status), with the options of `steps`. Writes nothing.
// A stage that reads a stale result is stale; its program is not asked.
CaptureStatus LookAtCapture(const Capture& capture, const std::vector<StageStep>& steps);

}  // namespace glint
