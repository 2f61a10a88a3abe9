// What the estimator is shown of a photograph: planes of features, one value a texel,
// and a profile of the whole.
//
//   plane 0–2  √(π·I / (E·NoL)) of R, G, B, at most 2: the albedo's root of a matte, flat texel
//         3    1 where a channel is clipped (LDR photographs only)
//         4    1 where the mask is at least 1/2, and where it hides a texel because it is clipped
//              (LDR and bright); elsewhere planes 0–4 are 0
//         5–6  x and y of the direction to the light        7–8  of the direction to the camera
//         9    angle between normal (the plane's) and half vector, in radians
//        10    ln(E·NoL/π), clamped to ±3: how dark the photograph is there
//
// The profile says, for kProfileBins rings of that angle: mean ln of the squares of planes 0–2, the
// spread of the green one, the clipped share, and whether the ring has texels at all. A highlight's
// width and height, and so roughness and specular albedo, are read off it.
#pragma once

#include <array>
#include <vector>

#include "fitting/photographs/photographs.h"

namespace glint {

inline constexpr int kFeaturePlanes = 11;
inline constexpr int kProfileBins = 12;
inline constexpr int kProfileValues = 6 * kProfileBins;

// What both forms of the features share (photograph_features_torch.h).
namespace features {
inline constexpr std::array<double, kProfileBins> kBinEndDegrees{1.5, 3,  5,  7.5, 10.5, 14,
                                                                 18,  23, 29, 36,  45,   90};
inline constexpr double kBrightest = 4.0;  // of π·I/(E·NoL)
inline constexpr double kClipped = 0.99;
inline constexpr double kOffset = 0.003;
inline constexpr double kLeastCosine = 0.02;
inline constexpr double kLeastIrradiance = 1e-9;
inline constexpr double kLogIrradianceRange = 3.0;
}  // namespace features

struct PhotographFeatures {
  int width = 0;
  int height = 0;
  std::vector<float> planes;   // kFeaturePlanes planes
  std::vector<float> profile;  // kProfileValues, [bin][value]
};

PhotographFeatures FeaturesOf(const Photograph& photograph, const SamplePlane& plane,
                              const ReflectanceConvention& convention);

}  // namespace glint
