// Residuals as pictures: by place on the board, and photograph by photograph.
#pragma once

#include "base/images/image.h"
#include "calib/validation/diagnosis.h"

namespace glint {

// A plan of the board, +y up. Arrows: how far each corner seems to lie from its place, magnified;
// discs: how far above (red) or below (blue) the board's plane. The scale stands below.
Image PlacesPicture(const Diagnosis& diagnosis, int width_px = 900);

// A small picture per accepted photo of a camera: its residuals, magnified alike in all, in its
// middle the axes along which they scatter, and what was found.
Image PhotosPicture(const BundleResult& result, const Diagnosis& diagnosis, int camera,
                    int width_px = 1200);

}  // namespace glint
