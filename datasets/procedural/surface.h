// From a family's row function to maps: placing it in the plane, relief to normals, metalness to
// diffuse and specular albedo.
#pragma once

#include <cstdint>
#include <optional>

#include "base/reflectance/svbrdf_maps.h"
#include "datasets/procedural/families/families.h"

namespace glint::procedural {

// `finish`: seed of finish.h's changes; none: the family's own look.
SvbrdfMaps MakeSurface(const Family& family, uint64_t seed, std::optional<uint64_t> finish,
                       int width, int height);

}  // namespace glint::procedural
