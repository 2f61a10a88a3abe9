// From a family's row function to maps: placing it in the plane, relief to normals, metalness to
// diffuse and specular albedo.
#pragma once

#include <cstdint>

#include "datasets/procedural/families/families.h"
#include "fitting/reflectance/svbrdf_maps.h"

namespace glint::procedural {

SvbrdfMaps MakeSurface(const Family& family, uint64_t seed, int width, int height);

}  // namespace glint::procedural
