// The Ceres problem of the light; apart from light_state.h because Ceres is heavy.
#pragma once

#include <ceres/problem.h>

#include "calib/light/light_state.h"

namespace glint::light {

// Residuals of all inliers of used photos, photo by photo, spot by spot, three each.
void AddSpots(bool robust, State* state, ceres::Problem* problem);
void AddPriors(const LightOptions& options, State* state, ceres::Problem* problem);
// To be called last: the first photo's exposure, and what the state holds.
void HoldBlocks(State* state, ceres::Problem* problem);

}  // namespace glint::light
