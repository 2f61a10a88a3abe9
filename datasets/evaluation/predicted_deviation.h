// How far a view may be expected from its photograph, by what refinement says of its maps.
#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include "base/formats/rectified_set.h"
#include "datasets/looks/view_error.h"

namespace glint {

// Standard deviations of maps, and of the residuals that they leave.
struct StatedDeviations {
  int width = 0, height = 0;
  std::vector<float> planes;      // normal x, y; diffuse; specular rgb; roughness: 9·H·W
  double residual_deviation = 0;  // of log(I + 0.01)
  // By how much views deviate whose deviations are not known (view_deviations.h).
  double exposure_spread = 0, light_spread = 0;
};

// Of confidence.exr beside the manifest of `refine`; none: the stage writes none. Throws UserError.
std::optional<StatedDeviations> ReadStatedDeviations(const std::filesystem::path& manifest);

// Standard deviation of log(I + 0.01) [3·H·W] of the view's photograph: the residuals' own, what
// each map's deviation moves the rendering by and, where the view was not fitted, what a deviation
// of its exposure and of its light does; all independent (central differences of one standard
// deviation either way).
std::vector<float> PredictedDeviation(const FittedMaps& fit, const StatedDeviations& stated,
                                      const RectifiedSet& set, const RectifiedView& view,
                                      int threads);

// Share of a plane's values whose truth lies within `widths` standard deviations.
struct Coverage {
  double normal = 0, diffuse = 0, specular = 0, roughness = 0;
};
Coverage CoverageOf(const SvbrdfMaps& maps, const SvbrdfMaps& truth, const StatedDeviations& stated,
                    double widths);

}  // namespace glint
