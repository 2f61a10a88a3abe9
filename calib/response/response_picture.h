// A picture of a response curve.
#pragma once

#include "base/images/image.h"
#include "base/linearize/response_curve.h"

namespace glint {

// Left: linear value over stored value, both on logarithmic axes, with gamma 2.2 (grey) and sRGB
// (light grey); right: what the curve makes of the picture against gamma 2.2, in stops.
Image ResponsePicture(const ResponseCurve& curve, int side_px = 480);

}  // namespace glint
