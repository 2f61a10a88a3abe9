// The material as a MaterialX 1.38 document: generalized_schlick_bsdf of our F0 and α = roughness²
// added to a Lambertian lobe, which is our reflectance but for the masking term and Schlick's
// power.
#pragma once

#include <functional>
#include <string>

#include "pipeline/export/export_maps.h"

namespace glint {

std::string MaterialXOf(const ExportedMaterial& material,
                        const std::function<std::string(const std::string& map)>& file_of);

}  // namespace glint
