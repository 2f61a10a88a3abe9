// Three by three repetitions of a tile, lit from the upper left, as a picture.
#pragma once

#include <filesystem>

#include "base/reflectance/convention.h"
#include "base/reflectance/svbrdf_maps.h"

namespace glint {

// 8 bits, at most 900 pixels along the longer side; width_mm, height_mm: one tile's.
void WriteTilePreview(const std::filesystem::path& file, const SvbrdfMaps& tile, double width_mm,
                      double height_mm, ReflectanceConvention convention, int threads);

}  // namespace glint
