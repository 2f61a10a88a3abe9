// A capture as its folder describes it now: described by capture.toml, begun (a draft), or with a
// capture.toml that cannot be read.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "base/formats/capture.h"
#include "pipeline/studio/captures/new_capture.h"
#include "pipeline/studio/captures/program_message.h"

namespace glint {

struct CaptureState {
  std::filesystem::path folder;
  std::optional<Capture> capture;  // none: a draft, or broken
  std::optional<NewCapture> draft;
  ProgramMessage problem;  // of a capture.toml that cannot be read
};

CaptureState ReadState(const std::filesystem::path& folder);

// "board", "single", "rectified" or "fixed camera".
std::string KindOf(const CaptureState& state);

// As `glint init --single` describes it: a second photograph has no place in it.
bool IsOfOnePhotograph(const CaptureState& state);

// Throws HttpError 409: a draft has no capture.toml that could be changed or run.
void RequireDescription(const std::filesystem::path& folder);

}  // namespace glint
