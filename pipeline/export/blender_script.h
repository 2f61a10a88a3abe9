// The material as a Python script for Blender 3.4 or later: a plane of the sample's true size with
// nodes of a diffuse and a glossy lobe, added as our reflectance adds them, and displacement.
#pragma once

#include <functional>
#include <string>

#include "pipeline/export/export_maps.h"

namespace glint {

std::string BlenderScriptOf(const ExportedMaterial& material,
                            const std::function<std::string(const std::string& map)>& file_of);

}  // namespace glint
