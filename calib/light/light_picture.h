// What the paper's brightness has left over, as a picture.
#pragma once

#include "base/images/image.h"
#include "calib/light/light.h"

namespace glint {

// One panel per photograph in its stored picture: each spot of paper in blue (darker than
// predicted) through white to red (brighter), full colour at ±`full_percent`; crosses: rejected.
Image LightPicture(const LightProblem& problem, const LightEstimate& estimate,
                   double full_percent = 3, int panel_px = 320);

}  // namespace glint
