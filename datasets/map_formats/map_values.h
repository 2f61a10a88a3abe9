// Stored values of single maps to those of SvbrdfMaps; shared by the layouts' readers.
#pragma once

#include <algorithm>
#include <cmath>

#include "base/reflectance/svbrdf_maps.h"

namespace glint {

inline constexpr float kDielectricF0 = 0.04f;
inline constexpr float kSmallestRoughness = 0.5f / 255;  // r = 0 is a mirror that no light hits

// Stores the unit normal of encoded components in [0, 1]. Components below the horizon, as lossy
// compression leaves them, are lifted to it.
inline void StoreNormal(float x01, float y01, float z01, size_t texel, SvbrdfMaps* maps) {
  const float x = 2 * x01 - 1, y = 2 * y01 - 1, z = std::max(2 * z01 - 1, 1e-3f);
  const float length = std::sqrt(x * x + y * y + z * z);
  maps->plane(kNormalX)[texel] = x / length;
  maps->plane(kNormalY)[texel] = y / length;
  maps->plane(kNormalZ)[texel] = z / length;
}

inline void StoreRoughness(float value, size_t texel, SvbrdfMaps* maps) {
  maps->plane(kRoughness)[texel] = std::clamp(value, kSmallestRoughness, 1.0f);
}

}  // namespace glint
