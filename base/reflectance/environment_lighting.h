// Environment lighting: light that reaches the sample from elsewhere than the flash, and what a
// texel reflects of it.
//
// Radiance over directions in real spherical harmonics about the sample's frame, in the usual order
// (by degree l, then m from -l to l), scaled so that the mean of each term's square over all
// directions is 1.
//
// Diffuse: the irradiance of the texel's plane has the terms of degree l times π, 2π/3, π/4, 0, ...
// at the normal (Ramamoorthi and Hanrahan, "An efficient representation for irradiance environment
// maps", SIGGRAPH 2001). Specular: the radiance from the mirrored direction, of degree l times the
// lobe's integral seen from the front
//   h_l = ∫ D·G1(cos 2θ)·P_l(cos 2θ)·cos θ dω   over half vectors, θ from the normal,
// without Fresnel's rise toward grazing views, as the ambient term of brdf.h.
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "base/model/view_correction.h"
#include "base/reflectance/brdf.h"

namespace glint {

using constants::kEnvironmentDegree;  // the highest
inline constexpr int kEnvironmentTerms = (kEnvironmentDegree + 1) * (kEnvironmentDegree + 1);

// Whether so many terms are all of some degrees, or none.
bool AreEnvironmentTerms(size_t terms);

struct EnvironmentLighting {
  std::vector<Vec3d> radiance_rgb;  // (degree + 1)² terms, at most kEnvironmentTerms; empty: dark

  int terms() const { return static_cast<int>(radiance_rgb.size()); }
  int degree() const;
  bool any() const { return !radiance_rgb.empty(); }
  void Add(const EnvironmentLighting& more);
  // Of the sample's plane.
  Vec3d PlaneIrradiance() const;
  // From where the unit `direction` points.
  Vec3d RadianceFrom(const Vec3d& direction) const;
};

using EnvironmentHarmonics = std::array<double, kEnvironmentTerms>;

// What one texel reflects of each term, as irradiance.
class EnvironmentReflection {
 public:
  // Normal and roughness are taken from `texel`.
  explicit EnvironmentReflection(const TexelSvbrdf<double>& texel);

  // What its diffuse lobe receives (TexelGeometry::ambient), whatever the view …
  const EnvironmentHarmonics& diffuse() const { return diffuse_; }
  // … and π times what its highlight sees (ambient_specular), seen from `camera`: unit, texel to
  // camera. Terms above `degree` are 0.
  EnvironmentHarmonics Specular(const double camera[3], int degree = kEnvironmentDegree) const;

  // Adds `environment` to what the texel receives in a view of `exposure`.
  void AddTo(const EnvironmentLighting& environment, double exposure,
             TexelGeometry<double>* geometry) const;

 private:
  double normal_[3];
  EnvironmentHarmonics diffuse_;
  std::array<double, kEnvironmentDegree + 1> filter_;
  int specular_degree_ = kEnvironmentDegree;  // above it the highlight is too wide to see any
};

// Σ terms·radiance_rgb over the terms of `environment`; `terms` has as many at least.
Vec3d EnvironmentIrradiance(const EnvironmentLighting& environment, std::span<const double> terms);

}  // namespace glint
