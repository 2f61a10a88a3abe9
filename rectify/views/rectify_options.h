// What can be chosen about rectification, and what a capture settles.
#pragma once

#include <string>
#include <vector>

#include "base/formats/capture.h"
#include "base/linearize/linear_photo.h"
#include "base/programs/options.h"
#include "base/reflectance/view.h"
#include "rectify/resample/resample.h"

namespace glint {

struct RectifyOptions {
  int resolution = 0;                 // width of the views in texels; 0: [sample] resolution_px
  std::string filter = "sharp";       // sharp, soft, lanczos: see filter_kernel.h
  double saturation_level = 0.995;    // stored value from which 8/16 bit and RAW count as clipped
  double float_saturation_level = 0;  // the same for float photographs; 0: they never clip
  std::string exposure = "calib";     // as calib found it; exif: where all photos have it; equal
  double frame_height_mm = 0;  // the board frame's thickness: it shades and hides the sample's rim
  double frame_margin_mm = 0;  // this near to the frame nothing is used
};

void AddRectifyOptions(OptionSet* set, RectifyOptions* options);

// The values of capture.toml that the result depends on, resolved with the options. They enter the
// manifest as options, so that a change of theirs makes the result stale and others do not.
struct RectifyTask {
  std::vector<double> sample_size_mm;    // width, height
  std::vector<double> resolution_px;     // width, height
  std::string encoding;                  // auto, srgb, gamma2.2, linear
  std::vector<double> ambient;           // r, g, b
  std::vector<double> board_opening_mm;  // left, bottom, right, top of the board's window; or empty
};

// Throws UserError for a resolution that leaves a side out of range.
RectifyTask ResolveTask(const Capture& capture, const RectifyOptions& options);
void AddTask(OptionSet* set, RectifyTask* task);

SamplePlane PlaneOf(const RectifyTask& task);
ResampleOptions ResampleOptionsOf(const RectifyOptions& options, int threads);
SaturationRule SaturationRuleOf(const RectifyOptions& options);

}  // namespace glint
