// How the light of all photographs of a capture differs from what is said of it, where nobody
// calibrated it. Unlike errors of single views (view_correction.h), this is known of photographs
// that were not fitted too.
#pragma once

#include <array>

#include "fitting/reflectance/view.h"
#include "fitting/view_correction/flash_offset.h"

namespace glint {

// Of the logarithm of the light's intensity.
enum LightShape : int {
  kBeamX,          // View::beam: telephones' flashes and lenses fall off toward the edges, and one
  kBeamY,          // whose axis passes beside the sample lights one side of it more
  kDistancePower,  // by the logarithm of the light's distance: an automatic exposure makes up for
                   // distance, and distances that are not known well do not vary as much as said
  kLightShapes
};
using LightShapeValues = std::array<double, kLightShapes>;

struct SharedLight {
  FlashOffset offset_mm{0, 0, 0};
  LightShapeValues shape{};
  double distance_mm = 1;  // at which kDistancePower changes nothing

  bool operator==(const SharedLight&) const = default;
};

View WithSharedLight(const View& said, const SharedLight& shared);

// Derivatives by the shape's values of the logarithm of what a texel receives, the light where
// `view` has it.
LightShapeValues ByLightShape(const View& view, double distance_mm, double x_mm, double y_mm);

}  // namespace glint
