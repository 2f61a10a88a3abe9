// Where the flash stands beside where it is said to be, the same in all photographs.
//
// Captures that were not calibrated take the light to be at the camera, or at a place measured by
// hand. A flash that is a tenth of its distance aside moves every highlight by a twentieth of the
// distance, and maps that are fitted without knowing it tilt the sample instead. Unlike errors of
// single views (view_correction.h), the offset is known of photographs that were not fitted too.
#pragma once

#include "base/reflectance/view.h"

namespace glint {

// In millimetres, in the frame of an upright camera that looks along the light's direction: x
// right, y up, z toward the light. (Of the camera's turn about its axis a View says nothing.)
using FlashOffset = Vec3d;

View WithFlashOffset(View view, const FlashOffset& offset_mm);

}  // namespace glint
