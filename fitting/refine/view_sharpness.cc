#include "fitting/refine/view_sharpness.h"

#include <algorithm>
#include <cmath>

#include "base/model/photographs.h"

namespace glint {

PointSpread SpreadOf(const RefineView& view, const RefineOptions& options) {
  if (view.spread_variance) return PointSpread(*view.spread_variance);
  const bool measured = options.measured_blur && view.blur_px > 0;
  return {view.pixels_per_texel, measured
                                     ? std::hypot(view.blur_px, constants::kResamplingSpread_px)
                                     : options.point_spread_px};
}

void WeighViews(double variance, RefineProblem* problem) {
  for (RefineView& view : problem->views) {
    view.weight = view.hidden_variance > 0 ? variance / (variance + view.hidden_variance) : 1;
  }
}

}  // namespace glint
