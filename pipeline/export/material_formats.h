// The registry of material files: what other programs read as a whole material rather than map by
// map. To add one, write its file's text and its line in material_formats.cc.
#pragma once

#include <array>
#include <functional>
#include <string>
#include <vector>

#include "pipeline/export/direction_pairs.h"
#include "pipeline/export/export_maps.h"

namespace glint {

struct MaterialFormat {
  std::string name;    // as --formats says: "gltf"
  std::string suffix;  // of the file beside the maps, after the material's name: ".glb"
  // The file's bytes. `files`: where each map lies (its 8-bit picture, else the 16-bit one),
  // relative to the file. The same for any number of threads.
  std::function<std::string(const ExportedMaterial& material,
                            const std::function<std::string(const std::string& map)>& file_of,
                            int threads)>
      write;
  // How that format's own shading reflects (direction_pairs.h); what is stated of its fidelity.
  std::function<std::array<double, 3>(const ExportedMaterial& material, size_t texel,
                                      const DirectionPair& pair)>
      brdf;
};

const std::vector<MaterialFormat>& MaterialFormats();
// "gltf, materialx, …"
std::string MaterialFormatNames();
// Those named, or all. Throws UserError on a name that is none.
std::vector<MaterialFormat> ChosenFormats(const std::vector<std::string>& names);

}  // namespace glint
