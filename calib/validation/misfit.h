// Why corners do not fit: a photograph with another focal length or cut off-centre, a board that
// was printed higher than wide.
#pragma once

#include <optional>
#include <string>

#include "calib/bundle/bundle.h"

namespace glint {

// How a rejected photograph would go with the others.
struct OtherView {
  double zoom = 1;                     // its focal length, as a multiple of the others'
  Eigen::Vector2d shift_px{0, 0};      // of its picture, beyond a zoom about the picture's centre
  double before_px = 0, after_px = 0;  // RMS of its corners' residuals without and with these
};

// Fits pose, zoom and shift of `photo`, of which the other intrinsics stay those of `result`.
// nullopt: neither explains its corners.
std::optional<OtherView> ExplainByOtherView(const BundleResult& result, const PhotoEstimate& photo);

// "as if taken with 1.25 times the others' focal length: …"
std::string InWords(const OtherView& view);

// The board's height against what it should be for its width, less 1, where that explains the
// corners of all photographs (rejected ones too); 0: it does not, or nothing hints at it.
struct BoardStretch {
  double relative = 0;
  double before_px = 0, after_px = 0;  // RMS with square pixels, without and with it
};
BoardStretch FindBoardStretch(const BundleProblem& problem, const BundleOptions& options,
                              const BundleResult& result);
std::string InWords(const BoardStretch& stretch);

}  // namespace glint
