#include "rectify/resample/footprint.h"

#include <algorithm>
#include <cmath>

namespace glint {

Footprint FootprintFromJacobian(const TexelJacobian& j) {
  // J·Jᵀ = [p q; q s] = U diag(λ) Uᵀ with λ the squared axes of the texel's ellipse in pixels.
  const double p = j.x_by_column * j.x_by_column + j.x_by_row * j.x_by_row;
  const double q = j.x_by_column * j.y_by_column + j.x_by_row * j.y_by_row;
  const double s = j.y_by_column * j.y_by_column + j.y_by_row * j.y_by_row;
  const double mean = (p + s) / 2;
  const double spread = std::hypot((p - s) / 2, q);
  const double major = std::max(mean + spread, 1.0);
  const double minor = std::max(mean - spread, 1.0);
  // Direction of the major axis, by half the angle of (p − s, 2q): cos² and sin·cos of it.
  double cos2 = 1, sin_cos = 0;
  if (spread > 1e-12 * mean) {
    cos2 = (1 + (p - s) / 2 / spread) / 2;
    sin_cos = q / spread / 2;
  }
  const double sin2 = 1 - cos2;
  return {cos2 / major + sin2 / minor, 2 * sin_cos * (1 / major - 1 / minor),
          sin2 / major + cos2 / minor, cos2 * major + sin2 * minor, sin2 * major + cos2 * minor};
}

}  // namespace glint
