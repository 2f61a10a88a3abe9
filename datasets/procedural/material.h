// Procedural SVBRDFs: endless training and test materials that follow from a number.
//
// A material is a function of the plane; a picture samples it at texel centres, its longer side one
// unit long. So one seed shows the same material at every resolution. Nothing here depends on
// threads, time or earlier calls: any number of threads may call at once.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "base/reflectance/svbrdf_maps.h"

namespace glint {

// Seeds from here on are reserved for evaluation. Training draws its seeds below.
inline constexpr uint64_t kReservedSeedBase = 1'000'000'000;

// What a seed stands for.
struct MaterialRecipe {
  uint64_t seed = 0;
  std::string family;  // one of MaterialFamilies()
  std::string second;  // the family blended into it, or empty
  // Finished as things in use are (finish.h): detail down to the texels, dirt, wear, less contrast.
  bool finished = false;
};

// Names of the families, in a fixed order.
std::vector<std::string> MaterialFamilies();

// Whether a family is wood or painted, which people varnish. Throws std::invalid_argument for an
// unknown family.
bool IsWoodOrPaint(const std::string& family);

// Family and blend that MakeMaterial(seed, …) draws.
MaterialRecipe DrawRecipe(uint64_t seed);

// Maps of the material `seed`: family, parameters and possibly a second material blended in by a
// mask (convex mixtures as in Deschaintre et al. 2018, sec. 4.2) are all drawn from the seed.
// Every plane is within its range of SvbrdfMaps: unit normals with z > 0, tilted at most 77°;
// diffuse + specular ≤ 1 per channel; dielectric F0 .02 to .08, in the tail of finished ones .2;
// roughness .05 to 1.
// Throws std::invalid_argument for a width or height outside 1 … 8192.
SvbrdfMaps MakeMaterial(uint64_t seed, int width, int height);

// Maps of one family, never blended or finished. Also throws std::invalid_argument for an unknown
// family.
SvbrdfMaps MakeMaterial(const std::string& family, uint64_t seed, int width, int height);

// Maps of a recipe: what MakeMaterial(recipe.seed, …) returns when the recipe was drawn from it.
SvbrdfMaps MakeMaterial(const MaterialRecipe& recipe, int width, int height);

}  // namespace glint
