// Radiance of one texel in one view with its derivatives by the texel's ten stored values, from the
// slopes of brdf_core.h: what the vector kernels are compared with.
#pragma once

#include <algorithm>

#include "base/reflectance/brdf.h"
#include "base/reflectance/svbrdf_maps.h"

namespace glint {

// `jacobian`: 3×kSvbrdfPlanes row-major in the order of SvbrdfPlane. The normal's three components
// are free variables (see brdf.h about the radial one).
inline void ShadeTexel(const TexelSvbrdf<double>& texel, const TexelGeometry<double>& geometry,
                       const ReflectanceConvention& convention, double radiance[3],
                       double jacobian[3 * kSvbrdfPlanes]) {
  const MixTerms<double> lobe = EvaluateMix(texel, geometry, convention.lobes);
  const LobeMix<double> mix = LobeMixOf<double>(convention.lobes);
  ShadeRadiance(texel, geometry, convention, radiance);
  std::fill_n(jacobian, 3 * kSvbrdfPlanes, 0.0);
  for (int c = 0; c < 3; ++c) {
    const DiffuseTerms<double> diffuse = DiffuseLobe(texel, convention.diffuse_weight, c);
    const ChannelTerms<double> channel =
        EvaluateChannel(diffuse, texel.specular[c], geometry.fresnel, lobe.n_dot_l, lobe.value);
    const ChannelSlopes<double> slopes = DifferentiateChannel(
        diffuse, channel, geometry.fresnel, lobe.n_dot_l, lobe.value, geometry.irradiance[c],
        geometry.ambient[c], geometry.ambient_specular[c], mix.mapped());
    SpecularSlopes<double> by = DifferentiateMix(lobe, texel.roughness, mix, slopes.by_lobe);
    if (mix.coat()) {
      by += DifferentiateCoat(lobe, texel.roughness, mix,
                              geometry.irradiance[c] * Fresnel(mix.coat_f0, geometry.fresnel));
    }
    double* row = jacobian + c * kSvbrdfPlanes;
    row[kDiffuseR + c] = slopes.by_diffuse;
    row[kSpecularR + c] = slopes.by_specular;
    row[kRoughness] = by.by_roughness;
    const double lit = lobe.lobes[0].free.n_dot_l > kDotClamp ? slopes.by_n_dot_l : 0.0;
    for (int i = 0; i < 3; ++i) {
      row[kNormalX + i] = lit * geometry.light[i] + by.by_n_dot_l * geometry.light[i] +
                          by.by_n_dot_v * geometry.camera[i] + by.by_n_dot_h * geometry.half[i] +
                          2.0 * by.by_n_dot_n * texel.normal[i];
      if (i < 2) row[kNormalX + i] += by.by_n_dot_g * mix.shape.direction[i];
    }
  }
}

}  // namespace glint
