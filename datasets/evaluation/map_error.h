// How far estimated maps are from true ones: the figures of Gao et al. 2019 ("DIR"), table 1.
#pragma once

#include <cstdint>
#include <vector>

#include "base/reflectance/svbrdf_maps.h"
#include "base/reflectance/view.h"

namespace glint {

// Mean squared errors over texels and channels, of maps whose values lie in [0, 1]: diffuse,
// specular and roughness as stored (linear), the normal as (n + 1)/2 over its three components.
struct MapErrors {
  double diffuse = 0;
  double specular = 0;
  double roughness = 0;
  double normal = 0;
  double average() const { return (diffuse + specular + roughness + normal) / 4; }
};

// Both of one size (std::invalid_argument otherwise) and with diffuse weight 1 (ToUnitWeight in
// datasets/synth).
MapErrors CompareMaps(const SvbrdfMaps& estimate, const SvbrdfMaps& truth);

// Where a light and a camera stand for a novel rendering: independently.
//
// The paper says "100 random view and lighting directions". They are drawn here as its training
// draws independent pairs (sect. 4.2): both directions cosine-weighted over the hemisphere. Both
// stand at DIR's distance of 2.146 from the centre of a sample 2 units wide, so that all texels are
// in front of them and a highlight has its usual size; E = π without falloff (convention dir2019).
// Elevations under 10° are drawn again: there the whole sample is a few pixels high.
std::vector<View> NovelViews(int count, std::uint64_t seed);

inline constexpr int kNovelViews = 100;
inline constexpr std::uint64_t kNovelSeed = 2019;

// Mean over views, texels and channels of the squared difference of the two renderings, each
// clipped to [0, 1]. Sizes as in CompareMaps; the plane is [-1, 1]² (the longer side for other
// shapes).
double RenderError(const SvbrdfMaps& estimate, const SvbrdfMaps& truth,
                   const std::vector<View>& views, int threads);

// The paper's six figures.
struct Table1Row {
  MapErrors maps;
  double render = 0;
};
Table1Row EvaluateMaps(const SvbrdfMaps& estimate, const SvbrdfMaps& truth, int threads);

}  // namespace glint
