// How the light of all photographs of a capture, and what their curve makes of it, differ from what
// is said, where nobody calibrated it. Unlike errors of single views (view_correction.h), this is
// known of photographs that were not fitted too.
#pragma once

#include <array>
#include <span>

#include "base/reflectance/view.h"
#include "fitting/view_correction/deviating_view.h"

namespace glint {

enum SharedLightValue : int {
  kOffsetX,         // of the flash across the light's direction (flash_offset.h), of `distance_mm`:
  kOffsetY,         // the camera's place, or one measured by hand, is often stated for it
  kBeamX,           // View::beam: telephones' flashes and lenses fall off toward the edges, and one
  kBeamY,           // whose axis passes beside the sample lights one side of it more
  kDistancePower,   // of the light's intensity, by its distance: an automatic exposure makes up for
                    // distance, and distances that are not known well do not vary as much as said
  kSharedToe,       // of View::curve, in kToeUnit
  kSharedShoulder,  // likewise, 1
  kSharedLightValues
};
using SharedLightValues = std::array<double, kSharedLightValues>;

struct SharedLight {
  SharedLightValues values{};
  double distance_mm = 1;  // at which kDistancePower changes nothing

  bool operator==(const SharedLight&) const = default;
};

// From the sample's centre to the light; of at least one view.
double MeanLightDistance_mm(std::span<const View> views);

View WithSharedLight(const View& said, const SharedLight& shared);

// The deviation of a single view (deviating_view.h) that a shared value shows itself as.
constexpr ViewDeviation DeviationBy(SharedLightValue value) {
  switch (value) {
    case kOffsetX:
      return kLightAcrossX;
    case kOffsetY:
      return kLightAcrossY;
    case kSharedToe:
      return kToe;
    case kSharedShoulder:
      return kShoulder;
    default:
      return kLogExposure;
  }
}

// By how much that one deviates per unit of each shared value in one view at one place, the light
// where `view` has it.
SharedLightValues DeviationsByShared(const View& view, double distance_mm, double x_mm,
                                     double y_mm);

}  // namespace glint
