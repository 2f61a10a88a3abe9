// Texels that the board round the sample covers, shades from the flash or hides from the camera.
#pragma once

#include <vector>

#include "base/board/board.h"
#include "base/reflectance/view.h"
#include "rectify/resample/resample.h"

namespace glint {

// Per texel kMasked where the frame is in the way, else kOutside (that is: undecided). The frame is
// a sheet of thickness `height_mm` with its top that far above the sample's plane; it is in the way
// where the texel itself, or the point at that height on the ray to light or camera, lies outside
// of the opening (OpeningInSample) made smaller by `margin_mm`. With height_mm = 0 only what lies
// under the frame is masked; below 0, of a sample that rises above the frame, likewise.
std::vector<TexelStatus> MaskFrame(const SamplePlane& plane, const BoardRectangle& opening,
                                   double height_mm, double margin_mm, const View& view);

}  // namespace glint
