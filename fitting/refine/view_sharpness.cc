#include "fitting/refine/view_sharpness.h"

#include <algorithm>
#include <cmath>

#include "base/model/photographs.h"

namespace glint {

PointSpread SpreadOf(const RefineView& view, const RefineOptions& options) {
  const bool measured = options.measured_blur && view.blur_px > 0;
  return {view.pixels_per_texel, measured
                                     ? std::hypot(view.blur_px, constants::kResamplingSpread_px)
                                     : options.point_spread_px};
}

double BlurOf(double variance, double pixels_per_texel) {
  constexpr double kLeast_px = 0.01;  // 0 is one that is not known
  const double spread_px = std::sqrt(variance + constants::kTexelVariance) * pixels_per_texel;
  return std::sqrt(std::max(
      spread_px * spread_px - constants::kResamplingSpread_px * constants::kResamplingSpread_px,
      kLeast_px * kLeast_px));
}

void WeighViews(double variance, RefineProblem* problem) {
  for (RefineView& view : problem->views) {
    view.weight = view.hidden_variance > 0 ? variance / (variance + view.hidden_variance) : 1;
  }
}

}  // namespace glint
