// Where one capture stands, from what its folder holds: for a page about many of them. No program
// is started and no image is read, so that hundreds of captures take a moment; whether photographs
// and options are still those that results were made from is left to `glint status`.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "base/files/json.h"

namespace glint {

struct CaptureSummary {
  enum class State { kFailed, kUnfinished, kOutOfDate, kDone };  // worst first

  std::filesystem::path folder;
  std::string name;
  State state = State::kUnfinished;
  std::string stage;    // that failed, or is the first without a (current) result
  std::string message;  // of a failure: what its program said

  std::filesystem::path page;  // report/index.html, where there is one
  std::string thumbnail_jpeg;  // file's bytes; empty: none
  std::string verdict;         // calib's, of the photographs: "good", …

  // Where the results say so:
  std::optional<double> photographs, texels_across, texels_down, width_mm, height_mm;
  std::optional<double> reprojection_px;
  std::optional<double> log_l1, held_out_log_l1;  // of the photographs, by the page's manifest
  std::optional<double> seconds;                  // of all stages
};

// "failed", "unfinished", …
std::string ToText(CaptureSummary::State state);

// `folder` need not be a capture: one that cannot be read has failed, with the reason.
CaptureSummary SummariseCapture(const std::filesystem::path& folder);

Json ToJson(const CaptureSummary& summary);

// Where whoever runs a stage outside `glint run` leaves what it said when it failed, relative to
// the capture's folder: "glint/workflow/<stage>.failed". Gone once the stage succeeds.
std::filesystem::path FailureFile(const std::string& stage);

}  // namespace glint
