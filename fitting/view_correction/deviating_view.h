// What one photograph may deviate by from what is said of it: how bright its flash or its exposure
// was, where its flash stood, and what its curve does to the dark. What all photographs of a
// capture share is shared_light.h's.
#pragma once

#include <array>

#include "base/reflectance/view.h"

namespace glint {

enum ViewDeviation : int {
  kLogExposure,   // natural logarithm of a factor on the exposure
  kLightAcrossX,  // the light's offset across its direction, of its distance, in the frame of
  kLightAcrossY,  // flash_offset.h
  kToe,           // of View::curve, in kToeUnit
  kShoulder,      // likewise, 1
  kViewDeviations
};
// So that steps of all deviations are of one size.
inline constexpr double kToeUnit = 0.1;
inline constexpr bool IsOfCurve(size_t deviation) { return deviation >= kToe; }
using DeviationValues = std::array<double, kViewDeviations>;

View Deviating(const View& said, const DeviationValues& deviation);

}  // namespace glint
