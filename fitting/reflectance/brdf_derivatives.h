// Radiance of one texel in one view with its derivatives by the texel's ten stored values, written
// out by hand: for least squares (Ceres) without automatic differentiation and without allocation.
// The model and its notation are in brdf.h.
#pragma once

#include <type_traits>

#include "fitting/reflectance/brdf.h"
#include "fitting/reflectance/svbrdf_maps.h"

namespace glint {

// What is not zero of the 3×10 Jacobian of radiance: a channel depends on its own diffuse and
// specular albedo only. The normal's three components are free variables (see brdf.h about the
// radial one).
template <class T>
struct TexelDerivatives {
  T normal[3][3];  // [channel][axis]
  T diffuse[3];    // ∂radiance[c]/∂diffuse[c]
  T specular[3];   // ∂radiance[c]/∂specular[c]
  T roughness[3];  // ∂radiance[c]/∂roughness
};

// D·G/(4·NoL·NoV)·NoL, the factor of F in the radiance, with its derivatives.
template <class T>
struct SpecularLobe {
  T value;
  T by_roughness;
  T by_normal[3];
};

template <class T>
SpecularLobe<T> EvaluateSpecularLobe(const TexelSvbrdf<T>& texel,
                                     const TexelGeometry<T>& geometry) {
  const T n_dot_l_free = Dot(texel.normal, geometry.light);
  const T n_dot_v_free = Dot(texel.normal, geometry.camera);
  const T n_dot_h_free = Dot(texel.normal, geometry.half);
  const T n_dot_l = ClampBelow(n_dot_l_free, kDotClamp);
  const T n_dot_v = ClampBelow(n_dot_v_free, kDotClamp);
  const T n_dot_h = ClampBelow(n_dot_h_free, kDotClamp);
  const T alpha = texel.roughness * texel.roughness;
  const T k_free = alpha * T(0.5);
  const T k = ClampBelow(k_free, kDenominatorClamp);

  // D = (α/t)²/π
  T across[3], sine_squared(0);
  for (int i = 0; i < 3; ++i) {
    across[i] = texel.normal[i] - n_dot_h_free * geometry.half[i];
    sine_squared += across[i] * across[i];
  }
  const bool facing = n_dot_h_free > T(kDotClamp);
  if (!facing) sine_squared = T(1 - kDotClamp * kDotClamp);
  const T t_free = sine_squared + n_dot_h * n_dot_h * alpha * alpha;
  const T inverse_t = T(1) / ClampBelow(t_free, kDenominatorClamp);
  const bool t_varies = t_free > T(kDenominatorClamp);

  // S = (α/t)²·P, P = NoL / (4π·a·b)
  const T inverse_a = T(1) / (n_dot_l * (T(1) - k) + k);
  const T inverse_b = T(1) / (n_dot_v * (T(1) - k) + k);
  const T p_per_n_dot_l = T(0.25 * kInversePi) * inverse_a * inverse_b;
  const T p = p_per_n_dot_l * n_dot_l;
  const T ratio = alpha * inverse_t;

  SpecularLobe<T> lobe;
  lobe.value = ratio * ratio * p;
  const T by_t = t_varies ? T(-2) * lobe.value * inverse_t : T(0);
  T by_alpha = T(2) * ratio * inverse_t * p + by_t * T(2) * alpha * n_dot_h * n_dot_h;
  if (k_free > T(kDenominatorClamp)) {
    by_alpha -= T(0.5) * lobe.value * ((T(1) - n_dot_l) * inverse_a + (T(1) - n_dot_v) * inverse_b);
  }
  lobe.by_roughness = T(2) * texel.roughness * by_alpha;

  const T by_n_dot_l =
      n_dot_l_free > T(kDotClamp) ? ratio * ratio * p_per_n_dot_l * k * inverse_a : T(0);
  const T by_n_dot_v = n_dot_v_free > T(kDotClamp) ? -lobe.value * (T(1) - k) * inverse_b : T(0);
  const T by_across = facing ? T(2) * by_t : T(0);
  const T by_half = by_across * n_dot_h * alpha * alpha;
  for (int i = 0; i < 3; ++i) {
    lobe.by_normal[i] = by_n_dot_l * geometry.light[i] + by_n_dot_v * geometry.camera[i] +
                        by_across * across[i] + by_half * geometry.half[i];
  }
  return lobe;
}

// Radiance per channel and its derivatives in compact form.
template <class T>
void ShadeTexelCompact(const TexelSvbrdf<T>& texel, const TexelGeometry<T>& geometry,
                       DiffuseWeight weight, T radiance[3], TexelDerivatives<T>* derivatives) {
  const SpecularLobe<T> lobe = EvaluateSpecularLobe(texel, geometry);
  const T n_dot_l_free = Dot(texel.normal, geometry.light);
  const bool lit = n_dot_l_free > T(kDotClamp);
  const T n_dot_l = ClampBelow(n_dot_l_free, kDotClamp);
  for (int c = 0; c < 3; ++c) {
    const T irradiance = geometry.irradiance[c];
    const T fresnel = texel.specular[c] + (T(1) - texel.specular[c]) * geometry.fresnel;
    const T diffuse = DiffuseLobe(texel, weight, c);
    const T received = (irradiance * n_dot_l + geometry.ambient[c]) * T(kInversePi);
    radiance[c] = irradiance * (diffuse * n_dot_l + lobe.value * fresnel) +
                  AmbientRadiance(texel, geometry, weight, c);
    derivatives->diffuse[c] = received;
    derivatives->specular[c] = irradiance * lobe.value * (T(1) - geometry.fresnel) +
                               geometry.ambient_specular[c] * T(kInversePi);
    if (weight == DiffuseWeight::kOneMinusSpecular) {
      derivatives->diffuse[c] *= T(1) - texel.specular[c];
      derivatives->specular[c] -= received * texel.diffuse[c];
    }
    derivatives->roughness[c] = irradiance * fresnel * lobe.by_roughness;
    const T by_light = lit ? irradiance * diffuse : T(0);
    for (int i = 0; i < 3; ++i) {
      derivatives->normal[c][i] =
          by_light * geometry.light[i] + irradiance * fresnel * lobe.by_normal[i];
    }
  }
}

// The same with the full Jacobian, 3×kSvbrdfPlanes row-major in the order of SvbrdfPlane; may be
// null.
template <class T>
void ShadeTexel(const TexelSvbrdf<T>& texel, const TexelGeometry<T>& geometry, DiffuseWeight weight,
                T radiance[3], std::type_identity_t<T>* jacobian) {
  if (jacobian == nullptr) {
    ShadeRadiance(texel, geometry, weight, radiance);
    return;
  }
  TexelDerivatives<T> derivatives;
  ShadeTexelCompact(texel, geometry, weight, radiance, &derivatives);
  for (int i = 0; i < 3 * kSvbrdfPlanes; ++i) jacobian[i] = T(0);
  for (int c = 0; c < 3; ++c) {
    T* row = jacobian + c * kSvbrdfPlanes;
    for (int i = 0; i < 3; ++i) row[kNormalX + i] = derivatives.normal[c][i];
    row[kDiffuseR + c] = derivatives.diffuse[c];
    row[kSpecularR + c] = derivatives.specular[c];
    row[kRoughness] = derivatives.roughness[c];
  }
}

}  // namespace glint
