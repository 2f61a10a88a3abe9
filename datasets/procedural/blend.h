// Mixtures of two materials by a mask.
#pragma once

#include <cstdint>
#include <vector>

#include "fitting/reflectance/svbrdf_maps.h"

namespace glint::procedural {

// Weights of the second material in [0, 1], width×height, rows from the top: a constant, soft
// clouds, islands with hard borders, or a tiling, as the seed draws.
std::vector<float> DrawBlendMask(uint64_t seed, int width, int height);

// Texelwise convex mixture of every plane; normals mix by their slopes and keep unit length.
// Both maps and the mask have the same size.
SvbrdfMaps BlendMaterials(const SvbrdfMaps& first, const SvbrdfMaps& second,
                          const std::vector<float>& mask);

}  // namespace glint::procedural
