#include "fitting/refine/light_power.h"

#include <algorithm>

#include "base/reflectance/svbrdf_deviations.h"

namespace glint {

void SetUnderPower(double power, DiffuseWeight weight, SvbrdfMaps* maps,
                   std::vector<float>* confidence) {
  const auto scale = static_cast<float>(1 / power);
  const size_t texels = maps->texels();
  for (int c = 0; c < 3; ++c) {
    const auto diffuse = maps->plane(kDiffuseR + c), specular = maps->plane(kSpecularR + c);
    for (size_t t = 0; t < texels; ++t) {
      const float before = specular[t], now = std::min(scale * before, 1.0f);
      float matte = scale * diffuse[t];
      if (weight == DiffuseWeight::kOneMinusSpecular && now < 1) matte *= (1 - before) / (1 - now);
      specular[t] = now;
      diffuse[t] = std::min(matte, 1.0f);
    }
    for (const int plane : {kSigmaDiffuseR + c, kSigmaSpecularR + c}) {
      float* sigma = confidence->data() + static_cast<size_t>(plane) * texels;
      for (size_t t = 0; t < texels; ++t) sigma[t] *= scale;
    }
  }
}

}  // namespace glint
