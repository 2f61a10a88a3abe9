// The places where published reflectance models that share one formula still differ, as one value.
#pragma once

#include <string>
#include <string_view>

namespace glint {

// Weight of the diffuse lobe k_d/π: 1 (DIR 2019), or 1 − k_s per channel (Deschaintre 2018,
// MaterialGAN).
enum class DiffuseWeight { kOne, kOneMinusSpecular };

// Irradiance on a plane facing the light: `light_rgb` itself (DIR 2019 with light_rgb = π), or
// `light_rgb / d²` with d the distance from light to texel in millimetres.
enum class LightFalloff { kNone, kInverseSquare };

// Where texel i of n samples the extent [-s/2, s/2]: at (i + 0.5)/n, or corner to corner at i/(n −
// 1).
enum class TexelSampling { kPixelCentres, kCornerToCorner };

// In which direction of the sample lobes are wider, and how much wider than across.
struct Anisotropy {
  double ratio = 1;          // q of their α, 1 to kMostAnisotropy
  double direction_deg = 0;  // from the sample's x axis toward its y axis, from 0 to below 180

  bool any() const { return ratio > 1; }
  bool operator==(const Anisotropy&) const = default;
};

inline constexpr double kMostAnisotropy = 100;

// The sample's specular lobe: one of GGX, or beside it a narrow one of the same F0, by which a
// varnish or a polish shows a sharp peak on a wide glow,
//   S = (1 − s)·S(r·q^−s) + s·S(r·q^(1−s)),
// with s the narrow one's share and q the ratio of the two roughnesses. The roughness map r is
// their geometric mean by these shares; a lobe's own roughness is at most 1. Or the narrow one is a
// coat's, a varnish's on wood or on paper: it reflects white light by an F0 of its own, the same
// all over, and the specular map is the wide one's F0 alone.
//
// Each lobe's normals have Student's t-distribution of slopes (Ribardière, Bringier, Meneveaux and
// Simonot 2017), with γ the exponent of its tails:
//   D = (γ − 1)^γ α^(2γ − 2) / (π cos⁴θ ((γ − 1)α² + tan²θ)^γ)
// GGX for γ = 2, Beckmann's for γ → ∞; D(0) = 1/(πα²) for any γ.
//
// Of wood, cloth and brushed metal, lobes are wider in one direction of the sample than across it:
// with g that direction projected onto the texel's plane, and b across both, tan²θ becomes
// (h·g/(h·n))²/q + q·(h·b/(h·n))². That is α√q along g and α/√q along b, whose geometric mean is α
// (Ward 1992; Burley 2012). G is that of α.
struct SpecularLobes {
  double narrow_share = 0;  // s in [0, 1); 0: one lobe
  double narrow_ratio = 1;  // q in (0, 1]
  double coat_f0 = 0;       // of a coat, up to 1; 0: the narrow lobe has the specular map's F0
  int tail_exponent = 2;    // γ, kLeastTail to kMostTail
  Anisotropy anisotropy = {};

  bool two() const { return narrow_share > 0; }
  bool operator==(const SpecularLobes&) const = default;
};

inline constexpr int kLeastTail = 2, kMostTail = 32;

struct ReflectanceConvention {
  DiffuseWeight diffuse_weight = DiffuseWeight::kOne;
  LightFalloff falloff = LightFalloff::kInverseSquare;
  TexelSampling sampling = TexelSampling::kPixelCentres;
  SpecularLobes lobes = {};

  static ReflectanceConvention Photograph() { return {}; }
  static ReflectanceConvention Dir2019() {
    return {DiffuseWeight::kOne, LightFalloff::kNone, TexelSampling::kCornerToCorner};
  }
  static ReflectanceConvention MaterialGan() {
    return {DiffuseWeight::kOneMinusSpecular, LightFalloff::kInverseSquare,
            TexelSampling::kPixelCentres};
  }

  bool operator==(const ReflectanceConvention&) const = default;
};

// Names as manifests and EXR headers write them: "diffuse=one light=inverse_square
// sampling=pixel_centres", and " narrow_lobe=0.5x0.4" (share × ratio of roughnesses) of two lobes,
// " narrow_lobe=0.5x0.4@0.04" (@ F0) where the narrow one is a coat's, " tail=4" (γ) of tails other
// than GGX's, " anisotropy=1.5@90" (ratio @ degrees) of anisotropic ones.
std::string ToString(const ReflectanceConvention& convention);

// The inverse of ToString; also accepts the presets "photograph", "dir2019" and "materialgan".
// Throws std::invalid_argument that says what was found and what is allowed.
ReflectanceConvention ParseReflectanceConvention(std::string_view text);

}  // namespace glint
