// The base colour of a metal-roughness material of given metalness that reflects most like ours.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "pipeline/export/direction_pairs.h"

namespace glint {

// Reflectance as slope·base + rest, of a lobe D·G/(4·NoL·NoV) and the power in Fresnel's term.
struct LinearInBase {
  double slope = 0, rest = 0;
};
LinearInBase DielectricReflectance(double lobe, double fresnel);
LinearInBase MetalReflectance(double lobe, double fresnel);

// Radiances under a roughness's pairs of directions, white matte 1, as sums of what does not depend
// on a texel's colour. In rows by component, so that vector units take many pairs at once; pairs
// beyond the last are zero: no light, which every target matches.
struct PairTerms {
  static constexpr size_t kLanes = 16;  // floats in the widest vector unit
  static constexpr size_t kPadded = (kPairsOfRoughness + kLanes - 1) / kLanes * kLanes;
  using Row = std::array<float, kPadded>;
  // Ours: diffuse albedo · matte + F0 · mirror + rim.
  alignas(64) Row matte{}, mirror{}, rim{};
  // The target's of each kind: base · slope + rest.
  alignas(64) Row dielectric_slope{}, dielectric_rest{}, metal_slope{}, metal_rest{};
};

// `lobes`: ours; the target has one.
PairTerms TermsOf(double roughness, const SpecularLobes& lobes);

struct BestBase {
  float base = 0;   // 0 to 1
  float error = 0;  // of log radiance, mean over pairs
};

// Of one channel: `diffuse` with its lobe's weight, `specular` F0. Robust least squares of relative
// differences. The same bits on every processor.
BestBase BestBaseColor(const PairTerms& pairs, float metallic, float diffuse, float specular);

}  // namespace glint
