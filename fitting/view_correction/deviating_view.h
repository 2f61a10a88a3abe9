// What one photograph may deviate by from what is said of it: how bright its flash or its exposure
// was, and where its flash stood. What all photographs of a capture share is flash_offset.h's.
#pragma once

#include <array>

#include "base/reflectance/view.h"

namespace glint {

enum ViewDeviation : int {
  kLogExposure,   // natural logarithm of a factor on the exposure
  kLightAcrossX,  // the light's offset across its direction, of its distance, in the frame of
  kLightAcrossY,  // flash_offset.h
  kViewDeviations
};
using DeviationValues = std::array<double, kViewDeviations>;

View Deviating(const View& said, const DeviationValues& deviation);

}  // namespace glint
