// The material as a USD layer (.usda): UsdPreviewSurface in its specular workflow on a plane of the
// sample's true size, metres, z toward the viewer and y up.
#pragma once

#include <functional>
#include <string>

#include "pipeline/export/export_maps.h"

namespace glint {

std::string UsdOf(const ExportedMaterial& material,
                  const std::function<std::string(const std::string& map)>& file_of);

}  // namespace glint
