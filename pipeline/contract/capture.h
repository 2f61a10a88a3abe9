// capture.toml: a capture as its owner describes it. docs/capture.md lists every key.
#pragma once

#include <array>
#include <filesystem>
#include <string>
#include <vector>

#include "calib/board/board.h"

namespace glint {

struct Capture {
  std::filesystem::path folder;  // as given
  std::filesystem::path file;    // folder / "capture.toml"

  // [photos] files: patterns relative to the folder; found files, sorted, relative to the folder.
  std::vector<std::string> photos;
  // [board] photos: more photographs of the board, for the intrinsics alone.
  std::vector<std::string> board_photos;

  bool has_board = false;  // an imported set has none
  std::string
      board_file;  // [board] file, relative to the folder; empty: the table itself describes
  Board board;     // [board]; board_centre_in_sample_mm from [sample] centre_mm

  std::array<double, 2> sample_size_mm{0, 0};  // [sample] size_mm = [width, height]
  std::array<int, 2> resolution_px{0, 0};      // [sample] resolution_px = width, or [width, height]

  std::string encoding = "auto";  // [radiometry] encoding: auto, srgb, gamma2.2, linear
  std::array<double, 3> light_offset_mm{0, 0, 0};  // [light] offset_mm, in the camera frame
  std::array<double, 3> light_power{0, 0, 0};      // [light] power, radiance·mm²; zeros: estimate
  std::array<double, 3> ambient{0, 0, 0};          // [light] ambient

  std::filesystem::path work() const { return folder / "glint"; }
};

// Reads and checks the file; the stage tables [calib] … [report] are left to OptionSet::LoadToml.
// `folder` may also be the path of the capture.toml itself. Throws UserError.
Capture ReadCapture(const std::filesystem::path& folder);

}  // namespace glint
