// A small material as export hands it to formats.
#pragma once

#include <algorithm>

#include "pipeline/export/export_maps.h"

namespace glint::test {

inline constexpr int kSize = 16;  // smaller pictures are refused as photographs

inline SvbrdfMaps UniformMaps(const std::array<float, kSvbrdfPlanes>& values) {
  SvbrdfMaps maps(kSize, kSize);
  for (int p = 0; p < kSvbrdfPlanes; ++p) {
    std::fill(maps.plane(p).begin(), maps.plane(p).end(), values[static_cast<size_t>(p)]);
  }
  return maps;
}

inline ExportedMaterial MaterialOf(SvbrdfMaps maps, DiffuseWeight weight = DiffuseWeight::kOne) {
  ExportedMaterial material;
  material.name = "wood";
  material.maps = std::move(maps);
  material.convention.diffuse_weight = weight;
  material.width_mm = 120;
  material.height_mm = 80;
  material.metal = ToMetalRoughness(material.maps, material.convention, {}, 1);
  material.height_range_mm = {-0.5, 0.75};
  return material;
}

}  // namespace glint::test
