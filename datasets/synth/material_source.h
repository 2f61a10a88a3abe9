// Where the maps of a synthetic experiment come from: a file, or the procedural generator.
#pragma once

#include <string>
#include <vector>

#include "base/reflectance/convention.h"
#include "base/reflectance/svbrdf_maps.h"

namespace glint {

struct MaterialSource {
  std::string name;  // fit for a file name: "procedural_900001", "wood_07"
  SvbrdfMaps maps;
};

// `text` is "procedural:SEED", "procedural:FAMILY:SEED", or the path of svbrdf.exr, of a strip or
// of a folder of maps (datasets/map_formats). The result is size × size texels when size > 0, else
// as stored (procedural: 1024). The maps have diffuse weight 1. Throws UserError.
MaterialSource LoadMaterial(const std::string& text, int size);

// "procedural:SEED" of the first `count` seeds that training never draws.
std::vector<std::string> ReservedMaterials(int count);

// The same look with diffuse weight 1: k_d multiplied by what `convention` weighs it with.
SvbrdfMaps ToUnitWeight(SvbrdfMaps maps, const ReflectanceConvention& convention);

}  // namespace glint
