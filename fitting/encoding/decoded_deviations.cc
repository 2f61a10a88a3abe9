#include "fitting/encoding/decoded_deviations.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace glint {
namespace {

constexpr float kSqrt2 = std::numbers::sqrt2_v<float>;

// c = u², u = (t + 1)/2: Var u² = 4·u²·v + 2·v² for a Gaussian u of variance v.
float OfColour(float t, float sd) {
  const float u = 0.5f * (t + 1), v = 0.25f * sd * sd;
  return std::sqrt(4 * u * u * v + 2 * v * v);
}

}  // namespace

SvbrdfDeviations DecodedDeviations(const EncodedMaps& maps, const EncodedMaps& error) {
  SvbrdfDeviations deviations(maps.width, maps.height);
  const size_t texels = maps.texels();
  const auto t = [&](int plane, size_t i) {
    return std::clamp(maps.planes[static_cast<size_t>(plane) * texels + i], -1.0f, 1.0f);
  };
  const auto sd = [&](int plane, size_t i) {
    return kSqrt2 * error.planes[static_cast<size_t>(plane) * texels + i];
  };
  for (int c = 0; c < 3; ++c) {
    for (const auto& [encoded, plane] : {std::pair{kEncodedDiffuse + c, kSigmaDiffuseR + c},
                                         std::pair{kEncodedSpecular + c, kSigmaSpecularR + c}}) {
      const auto to = deviations.plane(plane);
      for (size_t i = 0; i < texels; ++i) to[i] = OfColour(t(encoded, i), sd(encoded, i));
    }
  }
  const auto roughness = deviations.plane(kSigmaRoughness);
  for (size_t i = 0; i < texels; ++i) {
    roughness[i] = 0.5f * (1 - kMinRoughness) * sd(kEncodedRoughness, i);
  }
  // Slopes s = t + 3·t³; n_x = s_x / √(1 + s_x² + s_y²), by s_x alone.
  for (size_t i = 0; i < texels; ++i) {
    float slope[2], slope_sd[2];
    for (int axis = 0; axis < 2; ++axis) {
      const float code = t(kEncodedNormal + axis, i);
      slope[axis] = code * (1 + 3 * code * code);
      slope_sd[axis] = (1 + 9 * code * code) * sd(kEncodedNormal + axis, i);
    }
    const float squared = 1 + slope[0] * slope[0] + slope[1] * slope[1];
    for (int axis = 0; axis < 2; ++axis) {
      const float by_slope = (squared - slope[axis] * slope[axis]) / (squared * std::sqrt(squared));
      deviations.plane(kSigmaNormalX + axis)[i] = by_slope * slope_sd[axis];
    }
  }
  return deviations;
}

}  // namespace glint
