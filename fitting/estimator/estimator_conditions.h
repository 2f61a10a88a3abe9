// What is known of a capture before its photographs are looked at. The estimator is told: the same
// photographs mean different maps where metals are rare or where the light was not calibrated.
#pragma once

namespace glint {

struct EstimatorConditions {
  // Dark and glossy texels are glass, lacquer or print rather than metal.
  bool metals_rare = false;
  // The light's power and place are measured; otherwise they are about right.
  bool light_calibrated = true;
};

inline constexpr int kEstimatorConditions = 2;  // as a row: metals_rare, light_calibrated

}  // namespace glint
