// The reflectance model: Cook–Torrance with GGX, as Gao et al. 2019 ("Deep Inverse Rendering", TOG
// 38(4)) and its published code use it: one texel in one view. The formulas are in brdf_core.h.
//
//   h = (l+v)/|l+v|, every dot product clamped to ≥ kDotClamp, α = r²
//   D = (α / (NoH²(α²−1) + 1))² / π
//   G = G1(NoL)·G1(NoV),  G1(x) = x / (x(1−k) + k),  k = α/2
//   F = k_s + (1−k_s)·2^(VoH(−5.55473·VoH − 6.98316))
//   f = w·k_d/π + D·G·F / (4·NoL·NoV),   w = 1 or 1−k_s (DiffuseWeight)
//   radiance = exposure·(E·f·NoL + ambient·(w·k_d + k_s)/π)
//
// D·G of two lobes (convention.h) is the sum of theirs by their shares; a coat's has an F of its
// own, and its share of the surroundings.
//
// The ambient term is a uniform surround reflected by a flat surface, its specular part without
// Fresnel's rise toward grazing views: what a metal shows of its surroundings.
//
// The scalar T may be float, double or an automatic-differentiation type (ceres::Jet).
//
// Two things keep the formulas finite and exact in float where the text's form is not:
// G1(x)/x is formed directly, so nothing divides by a small NoL or NoV; and D's denominator is
// |n − (n·h)h|² + NoH²α², which is the text's for a unit normal but does not lose a narrow
// highlight to the cancellation in 1 − NoH². That fixes what the model means beside the unit
// sphere, and so the radial part of derivatives by the normal: it must be projected out (as
// normalising does).
#pragma once

#include <cmath>
#include <numbers>

#include "base/reflectance/brdf_core.h"
#include "base/reflectance/convention.h"
#include "base/reflectance/view.h"

namespace glint {

// Reflectance of one texel; units and ranges as in svbrdf_maps.h, and in the order of its planes.
template <class T>
struct TexelSvbrdf {
  T normal[3];  // unit
  T diffuse[3];
  T specular[3];
  T roughness;
};

// One texel in one view. Make it with MakeTexelGeometry or TexelGeometryInView.
template <class T>
struct TexelGeometry {
  T light[3];             // unit, texel to light
  T camera[3];            // unit, texel to camera
  T half[3];              // unit, between them
  T fresnel;              // the power of two in F: depends on the directions only
  T irradiance[3];        // exposure·E
  T ambient[3];           // exposure·ambient, as the diffuse lobe receives it …
  T ambient_specular[3];  // … and as the specular one does: the same except under
                          // EnvironmentLighting
};

template <class T>
T Dot(const T a[3], const T b[3]) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

template <class T>
T FresnelWeight(const T& v_dot_h) {
  using std::exp2;
  return exp2(FresnelExponent(v_dot_h));
}

// As the formulas take them.
template <class S>
LobeShape<S> LobeShapeOf(const SpecularLobes& lobes) {
  LobeShape<S> shape;
  shape.exponent = lobes.tail_exponent;
  shape.stretch = S(std::sqrt(lobes.tail_exponent - 1.0));
  const Anisotropy& anisotropy = lobes.anisotropy;
  if (!anisotropy.any()) return shape;
  const double direction_rad = anisotropy.direction_deg * (std::numbers::pi / 180);
  shape.anisotropic = true;
  shape.direction[0] = S(std::cos(direction_rad));
  shape.direction[1] = S(std::sin(direction_rad));
  shape.ratio = S(anisotropy.ratio);
  shape.inverse_ratio = S(1 / anisotropy.ratio);
  return shape;
}

template <class S>
LobeMix<S> LobeMixOf(const SpecularLobes& lobes) {
  const LobeShape<S> shape = LobeShapeOf<S>(lobes);
  if (!lobes.two()) return {.shape = shape};
  const double wide = std::pow(lobes.narrow_ratio, -lobes.narrow_share);
  return {true,
          {S(1 - lobes.narrow_share), S(lobes.narrow_share)},
          {S(wide), S(wide * lobes.narrow_ratio)},
          shape,
          S(lobes.coat_f0)};
}

template <class T>
Cosines<T> CosinesOf(const TexelSvbrdf<T>& texel, const TexelGeometry<T>& geometry,
                     const LobeShape<ScalarOf<T>>& shape = {}) {
  Cosines<T> cosines{Dot(texel.normal, geometry.light), Dot(texel.normal, geometry.camera),
                     Dot(texel.normal, geometry.half), T(0)};
  T across[3];
  for (int i = 0; i < 3; ++i) across[i] = texel.normal[i] - cosines.n_dot_h * geometry.half[i];
  cosines.sine_squared = Dot(across, across);
  if (shape.anisotropic) {
    const auto& g = shape.direction;
    cosines.n_dot_g = texel.normal[0] * g[0] + texel.normal[1] * g[1];
    cosines.h_dot_g = geometry.half[0] * g[0] + geometry.half[1] * g[1];
  }
  return cosines;
}

// Of one lobe.
template <class T>
SpecularTerms<T> EvaluateSpecular(const TexelSvbrdf<T>& texel, const TexelGeometry<T>& geometry) {
  return EvaluateSpecular(CosinesOf(texel, geometry), texel.roughness);
}

template <class T>
MixTerms<T> EvaluateMix(const TexelSvbrdf<T>& texel, const TexelGeometry<T>& geometry,
                        const SpecularLobes& lobes) {
  const LobeMix<ScalarOf<T>> mix = LobeMixOf<ScalarOf<T>>(lobes);
  return EvaluateMix(CosinesOf(texel, geometry, mix.shape), texel.roughness, mix);
}

// D·G / (4·NoL·NoV) of one lobe.
template <class T>
T SpecularFactor(const TexelSvbrdf<T>& texel, const TexelGeometry<T>& geometry) {
  return EvaluateSpecular(texel, geometry).over_cosine;
}

// The diffuse lobe w·k_d/π of one channel.
template <class T>
DiffuseTerms<T> DiffuseLobe(const TexelSvbrdf<T>& texel, DiffuseWeight weight, int channel) {
  return EvaluateDiffuse(texel.diffuse[channel], texel.specular[channel],
                         weight == DiffuseWeight::kOneMinusSpecular);
}

// What is reflected of the surroundings, one channel of the radiance.
template <class T>
T AmbientRadiance(const TexelSvbrdf<T>& texel, const TexelGeometry<T>& geometry,
                  const ReflectanceConvention& convention, int channel) {
  const LobeMix<ScalarOf<T>> mix = LobeMixOf<ScalarOf<T>>(convention.lobes);
  T specular = texel.specular[channel];
  if (mix.coat()) specular = specular * mix.share[0] + mix.share[1] * mix.coat_f0;
  return geometry.ambient[channel] * DiffuseLobe(texel, convention.diffuse_weight, channel).value +
         geometry.ambient_specular[channel] * specular * T(kInversePi);
}

// The BRDF f, per channel [1/sr]. `geometry` needs its directions only.
template <class T>
void EvaluateBrdf(const TexelSvbrdf<T>& texel, const TexelGeometry<T>& geometry,
                  const ReflectanceConvention& convention, T brdf[3]) {
  const MixTerms<T> lobe = EvaluateMix(texel, geometry, convention.lobes);
  const Coat<T> coat = EvaluateCoat(lobe.coat_over_cosine, geometry.fresnel,
                                    LobeMixOf<ScalarOf<T>>(convention.lobes));
  for (int c = 0; c < 3; ++c) {
    brdf[c] = EvaluateChannel(DiffuseLobe(texel, convention.diffuse_weight, c), texel.specular[c],
                              geometry.fresnel, T(1), lobe.over_cosine, coat)
                  .reflected;
  }
}

// Radiance of the texel toward the camera, per channel.
template <class T>
void ShadeRadiance(const TexelSvbrdf<T>& texel, const TexelGeometry<T>& geometry,
                   const ReflectanceConvention& convention, T radiance[3]) {
  const MixTerms<T> lobe = EvaluateMix(texel, geometry, convention.lobes);
  const Coat<T> coat =
      EvaluateCoat(lobe.coat, geometry.fresnel, LobeMixOf<ScalarOf<T>>(convention.lobes));
  for (int c = 0; c < 3; ++c) {
    const ChannelTerms<T> channel =
        EvaluateChannel(DiffuseLobe(texel, convention.diffuse_weight, c), texel.specular[c],
                        geometry.fresnel, lobe.n_dot_l, lobe.value, coat);
    radiance[c] = geometry.irradiance[c] * channel.reflected +
                  AmbientRadiance(texel, geometry, convention, c);
  }
}

// Geometry from unit directions (texel to light, texel to camera), exposure·E and exposure·ambient.
template <class T>
TexelGeometry<T> MakeTexelGeometry(const T light[3], const T camera[3], const T irradiance[3],
                                   const T ambient[3]) {
  using std::sqrt;
  TexelGeometry<T> geometry;
  T sum[3];
  for (int i = 0; i < 3; ++i) sum[i] = light[i] + camera[i];
  // Opposite directions have no half vector; the clamp keeps its length finite.
  const T inverse = T(1) / sqrt(Arithmetic<T>::AtLeast(Dot(sum, sum), 1e-20));
  for (int i = 0; i < 3; ++i) {
    geometry.light[i] = light[i];
    geometry.camera[i] = camera[i];
    geometry.half[i] = sum[i] * inverse;
    geometry.irradiance[i] = irradiance[i];
    geometry.ambient[i] = geometry.ambient_specular[i] = ambient[i];
  }
  geometry.fresnel =
      FresnelWeight(Arithmetic<T>::AtLeast(Dot(geometry.camera, geometry.half), kDotClamp));
  return geometry;
}

// Geometry of the texel at (x_mm, y_mm, 0) in the sample frame, with the light of `view` moved to
// `light_in_sample_mm`, which may carry derivatives.
template <class T>
TexelGeometry<T> TexelGeometryLitFrom(const View& view, LightFalloff falloff,
                                      const T light_in_sample_mm[3], const T& x_mm, const T& y_mm) {
  using std::exp;
  using std::sqrt;
  const T position[3] = {x_mm, y_mm, T(0)};
  T light[3], camera[3], irradiance[3], ambient[3];
  for (int i = 0; i < 3; ++i) {
    light[i] = light_in_sample_mm[i] - position[i];
    camera[i] = T(view.camera_in_sample_mm[i]) - position[i];
  }
  const T light_inverse = T(1) / sqrt(Dot(light, light));
  const T camera_inverse = T(1) / sqrt(Dot(camera, camera));
  T attenuation = falloff == LightFalloff::kInverseSquare ? light_inverse * light_inverse : T(1);
  if (view.beam[0] != 0 || view.beam[1] != 0) {
    attenuation *= exp(-(T(view.beam[0]) * light[0] + T(view.beam[1]) * light[1]) / light[2]);
  }
  for (int i = 0; i < 3; ++i) {
    light[i] *= light_inverse;
    camera[i] *= camera_inverse;
    irradiance[i] = T(view.exposure * view.light_rgb[i]) * attenuation;
    ambient[i] = T(view.exposure * view.ambient_rgb[i]);
  }
  return MakeTexelGeometry(light, camera, irradiance, ambient);
}

template <class T>
TexelGeometry<T> TexelGeometryInView(const View& view, LightFalloff falloff, const T& x_mm,
                                     const T& y_mm) {
  const T light_in_sample_mm[3] = {T(view.light_in_sample_mm[0]), T(view.light_in_sample_mm[1]),
                                   T(view.light_in_sample_mm[2])};
  return TexelGeometryLitFrom(view, falloff, light_in_sample_mm, x_mm, y_mm);
}

}  // namespace glint
