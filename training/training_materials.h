// The endless sequence of materials that trainings draw from: procedural ones, packed ones from
// elsewhere (material_pack.h), and mixtures of the two.
#pragma once

#include <cstdint>

#include "datasets/material_pack/material_pack.h"
#include "training/material_pool.h"

namespace glint {

struct TrainingMaterialOptions {
  std::uint64_t seed = 1;
  int size = 256;              // texels along a material's side
  double pack_share = 0.5;     // of the materials that come from the pack, wholly or in part
  double mixture_share = 0.3;  // of those, that are mixed with a procedural material
  double glossy_dielectric_share = 0;  // of all, that are made dark dielectrics, wholly or in part
  // Of all, whose roughness and specular albedo hardly vary: most samples that people photograph
  // are one substance, printed or dyed.
  double one_substance_share = 0;
  // Of all, that have metal somewhere; the metals of the others become paint of their colour.
  // Negative: as the generator and the pack have them.
  double metal_share = -1;
  // Of wood and paint without metal, that have a thin clear smooth coat; of all else without metal
  // a fifth of it.
  double varnish_share = 0;
};

// What counts as metal, and the share of texels from which on a material is said to have some.
inline constexpr float kLeastMetalF0 = 0.2f;
inline constexpr double kLeastMetalShare = 0.02;
bool HasMetal(const SvbrdfMaps& maps);

// Material k. `pack` may be null or empty: procedural materials alone. Packed materials get a
// window of random place and scale; F0 of their dielectrics, which collections leave at 0.04, is
// drawn from [0.02, 0.08] with a tail, and half of them get another gain on their roughness. The
// pack's sides must be at least `size`. Glazed ones have the same pattern, up to a hundred
// times darker, no metal, and two thirds of them less relief and roughness.
SvbrdfMaps TrainingMaterial(const TrainingMaterialOptions& options, const MaterialPack* pack,
                            std::uint64_t k);

}  // namespace glint
