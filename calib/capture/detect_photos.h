// Corners and paper of every photograph, several photographs at a time.
#pragma once

#include <string>
#include <vector>

#include "base/formats/capture.h"
#include "calib/capture/calib_options.h"
#include "calib/capture/sample_picture.h"
#include "calib/corners/detector.h"
#include "calib/light/paper.h"
#include "calib/triage/measure.h"

namespace glint {

struct DetectedPhoto {
  std::string name;                 // relative to the capture's folder
  bool board_photo = false;         // for the intrinsics alone
  int width_px = 0, height_px = 0;  // upright
  int orientation = 1;              // EXIF
  double focal_length_35mm = 0;     // EXIF; 0: not told
  double exposure = 0;              // time · ISO / f-number²; 0: not told
  bool clips = true;                // 8 or 16 bit: at radiance 1
  std::string camera_model;
  BoardDetection detection;         // corners in the upright picture
  std::vector<PaperSample> paper;   // of flash photographs
  double sample_clipped_share = 0;  // see guidance/clipping.h
  PhotoMeasures measures;           // what triage goes by
  bool reduced = false;             // all this is of a smaller copy: as sharp as that is
  SamplePicture picture;            // of flash photographs
};

// In the capture's order, flash photographs first. At most `threads` photographs are in memory at a
// time. Throws what the first bad photograph throws.
std::vector<DetectedPhoto> DetectPhotos(const Capture& capture, const CalibOptions& options,
                                        int threads);

// Throws UserError, naming photographs and what is seen in them, where the board is seen in none or
// only one of several, or is another than described.
void RequireBoard(const Capture& capture, const CalibOptions& options,
                  const std::vector<DetectedPhoto>& photos);

}  // namespace glint
