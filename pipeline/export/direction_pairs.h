// Pairs of light and view directions by which another program's shading is compared with ours.
// Directions are unit and in the frame of a texel's normal.
#pragma once

#include <array>
#include <functional>
#include <vector>

#include "base/reflectance/brdf.h"
#include "base/reflectance/convention.h"
#include "base/reflectance/svbrdf_maps.h"

namespace glint {

struct DirectionPair {
  std::array<double, 3> light, camera;
  double v_dot_h = 1;
  TexelGeometry<double> geometry;  // unit irradiance, no ambient light
};

DirectionPair MakePair(const std::array<double, 3>& light, const std::array<double, 3>& camera);

// What other programs' GGX lobes have in common: D·G/(4·NoL·NoV) with Smith's height-correlated
// masking (Heitz, JCGT 2014) of α = roughness², and Schlick's (1 − VoH)⁵.
double SmithSpecular(const DirectionPair& pair, double roughness,
                     const Anisotropy& anisotropy = {});

// α of an anisotropic lobe, up to 1, along a direction of the surface and across it.
struct LobeWidths {
  double along, across, direction_deg;
};
LobeWidths WidthsOf(double roughness, const Anisotropy& anisotropy);
double SmithSpecular(const DirectionPair& pair, const LobeWidths& widths);
double SchlickWeight(double cosine);
// The first of a mix of lobes (base/reflectance/convention.h), each with its own roughness: of
// those that have the specular map's F0; and what a coat reflects, with its Fresnel term.
double SmithSpecular(const DirectionPair& pair, double roughness, const SpecularLobes& lobes);
double SmithCoat(const DirectionPair& pair, double roughness, const SpecularLobes& lobes,
                 double schlick_weight);

// Half of them on the highlight of that roughness (half vectors distributed as its normals are),
// half anywhere within 70° of the normal.
inline constexpr int kPairsOfRoughness = 48;
std::vector<DirectionPair> PairsForRoughness(double roughness);

// f [1/sr] of a texel under a pair of directions, per channel.
using Shading = std::function<std::array<double, 3>(size_t texel, const DirectionPair& pair)>;

// How far shading models are from ours: for each the mean over channels, a hundred pairs (fifty of
// each kind) and up to 4,096 texels of |log(theirs + 0.01) − log(ours + 0.01)|, in radiance of
// which a white matte texel under perpendicular light has 1. The same for any number of threads.
std::vector<double> ShadingErrors(const SvbrdfMaps& maps, const ReflectanceConvention& convention,
                                  const std::vector<Shading>& shadings, int threads);

}  // namespace glint
