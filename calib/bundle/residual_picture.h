// Reprojection errors as a picture: an arrow per corner, over the camera's image plane.
#pragma once

#include "base/images/image.h"
#include "calib/bundle/bundle.h"

namespace glint {

// Arrows run from where a corner is predicted to where it was seen, lengthened so that one of the
// RMS length is 1/40 of the picture's width; each photo has its colour, rejected corners are grey
// crosses. The picture is `width_px` wide, and tells its scale in words. Photos of one camera only.
Image ResidualPicture(const BundleResult& result, int camera, int width_px = 1200);

}  // namespace glint
