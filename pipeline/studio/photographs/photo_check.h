// What Studio says of one photograph a second after it has arrived: whether it shows the board, how
// sharp and how bright it is, and from where it was taken.
#pragma once

#include <array>
#include <filesystem>
#include <optional>
#include <string>

#include "base/board/board.h"
#include "base/files/json.h"
#include "base/formats/capture.h"
#include "calib/guidance/coverage.h"
#include "calib/triage/measure.h"

namespace glint {

// The longer side that is looked at: 12 megapixels at half their size, as for `glint calib
// --check`.
inline constexpr int kCheck_px = 2100;

// What a check depends on besides the photograph.
struct CheckTask {
  std::optional<Board> board;  // none: the capture has no board
  std::array<double, 2> sample_size_mm{0, 0};
  std::array<double, 3> light_offset_mm{0, 0, 0};  // of the flash, in the camera frame
  std::string Key() const;                         // the same for tasks that find the same
};
CheckTask CheckTaskOf(const Capture& capture);

struct PhotoCheck {
  std::string unreadable;  // why the file cannot be read; empty: it can
  PhotoMeasures measures;  // in pixels of the whole photograph; without name
  bool board_found = false;
  std::string board_problem;          // why it was not found
  bool mismatch = false;              // another board than the described one is seen
  double clipped_share = 0;           // of the sample, see guidance/clipping.h
  std::optional<GuidancePhoto> pose;  // where camera and flash were; without name
};

// Reads the photograph at a reduced size, finds the board and, with a pinhole camera of the focal
// length that EXIF reports (or a phone's usual one), the pose: planar PnP over the board's corners.
// `thumbnail_jpeg` returns a small picture, upright; empty where the file cannot be read. Never
// throws for what is wrong with the file.
PhotoCheck CheckPhoto(const std::filesystem::path& file, const CheckTask& task,
                      std::string* thumbnail_jpeg);

Json ToJson(const PhotoCheck& check);
// none: not such JSON.
std::optional<PhotoCheck> PhotoCheckFromJson(const Json& json);

}  // namespace glint
