// The photographs of a capture, used or left out, oldest first.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "pipeline/studio/captures/capture_state.h"

namespace glint {

struct StudioPhoto {
  std::string id, name;  // the file's
  std::string place;     // relative to the capture, as capture.toml lists it
  std::filesystem::path file;
  bool left_out = false;
  double added_s = 0;  // since 1970
};

std::vector<StudioPhoto> PhotosOf(const CaptureState& state);

// When the file was last written, since 1970; 0: there is none.
double ChangedAt_s(const std::filesystem::path& file);

}  // namespace glint
