// Base colour and metalness: the maps of a metal-roughness material whose own shading is nearest to
// ours.
//
// The target is glTF 2.0's material (specification, appendix B.2) with the roughness as it is: a
// dielectric of F0 = 0.04 whose diffuse lobe is weighted by 1 − F, blended with a metal of F0 =
// base colour. For a given metalness its radiance is linear in base colour, so for each of a few
// metalnesses the best base colour over pairs of light and view directions, on the highlight and
// beside it, is a closed form. What errors these leave, and how improbable the metalness is given
// F0, its colour and the diffuse light (kind_costs.h), is averaged over neighbours of like colour
// (cost-volume filtering: Hosni et al., PAMI 2013) before a texel takes the best, so that metalness
// is a property of substances, not of single texels.
#pragma once

#include <array>
#include <memory>
#include <vector>

#include "base/reflectance/convention.h"
#include "base/reflectance/material_kinds.h"
#include "base/reflectance/svbrdf_maps.h"
#include "pipeline/export/direction_pairs.h"

namespace glint {
namespace metal_tables {
struct Rows;
}

struct MetalRoughnessOptions {
  int radius = 4;  // texels, of the neighbours whose errors are averaged
  // Of √albedo: neighbours that differ by this count a little more than half, from twice it on
  // nothing.
  double colour_width = 0.1;
  // Cost of metalness ½ beside 0 and 1: nothing is half a metal. Of log radiance.
  double blend_cost = 0.003;
  // Prior share of metals among substances.
  double metal_share = MetalShareOf("rare");
};

struct MetalRoughness {
  int width = 0, height = 0;
  std::vector<float> base_color;  // linear, planar, 3·H·W, 0 to 1
  std::vector<float> metallic;    // H·W, 0 to 1

  std::array<float, 3> ColorAt(size_t texel) const;
};

// The same for any number of threads.
MetalRoughness ToMetalRoughness(const SvbrdfMaps& maps, const ReflectanceConvention& convention,
                                const MetalRoughnessOptions& options, int threads);

// The same by rows.
class MetalConverter {
 public:
  MetalConverter(const ReflectanceConvention& convention, const MetalRoughnessOptions& options,
                 int threads);
  ~MetalConverter();
  // Of `maps`, all but the first `above` and last `below` rows: options.radius where the sample
  // goes on, 0 at its border.
  MetalRoughness Convert(const SvbrdfMaps& maps, int above, int below);

 private:
  struct Tables;
  void ConvertRow(const SvbrdfMaps& maps, const metal_tables::Rows& rows, int above, int row,
                  MetalRoughness* result) const;
  ReflectanceConvention convention_;
  MetalRoughnessOptions options_;
  int threads_;
  std::unique_ptr<Tables> tables_;
};

// Its reflectance under one pair of directions: f [1/sr] per channel.
std::array<double, 3> MetalRoughnessBrdf(const std::array<float, 3>& base_color, double metallic,
                                         double roughness, const DirectionPair& pair);
// How it shades. Both must outlive it.
Shading MetalRoughnessShading(const MetalRoughness& converted, const SvbrdfMaps& maps);

}  // namespace glint
