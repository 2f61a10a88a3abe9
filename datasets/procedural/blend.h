// Mixtures of two materials by a mask.
#pragma once

#include <cstdint>

#include "base/reflectance/svbrdf_maps.h"
#include "datasets/procedural/plane.h"

namespace glint::procedural {

// Weights of the second material in [0, 1], as many as `first` has texels, rows from the top: a
// constant, soft clouds, islands with hard borders, a tiling, or what is dark or light in `first`,
// as the seed draws.
Plane DrawBlendMask(uint64_t seed, const SvbrdfMaps& first);
// The same without a material to look at: soft clouds in place of its dark or light.
Plane DrawBlendMask(uint64_t seed, int width, int height);

// Brings the mean diffuse colour and roughness of `second` toward those of `first`, as the seed
// draws: things that lie together share dust, dye and wear. Diffuse + specular stays ≤ 1.
void Reconcile(uint64_t seed, const SvbrdfMaps& first, SvbrdfMaps* second);

// Texelwise convex mixture of every plane; normals mix by their slopes and keep unit length.
// Both maps and the mask have the same size.
SvbrdfMaps BlendMaterials(SvbrdfMaps first, const SvbrdfMaps& second, const Plane& mask);

}  // namespace glint::procedural
