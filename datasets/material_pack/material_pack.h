// Materials from elsewhere, packed into one file for the trainer, which reads no pictures itself.
//
// A safetensors file: metadata "kind" = kMaterialPackKind and "encoding"; one tensor [9, S, S] of
// type I16 per material, its name the material's, values the encoded channels
// (fitting/encoding/encoding.h) times 32767. `glint-synth pack` writes it.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "base/reflectance/svbrdf_maps.h"

namespace glint {

inline constexpr char kMaterialPackKind[] = "glint-materials v1";

struct PackedMaterial {
  std::string name;
  int size = 0;                      // texels along a side
  std::vector<std::int16_t> values;  // [9, size, size]
};

using MaterialPack = std::vector<PackedMaterial>;

// Square maps. Throws std::invalid_argument when they are not.
PackedMaterial PackMaterial(const std::string& name, const SvbrdfMaps& maps);

void WriteMaterialPack(const std::filesystem::path& path, const MaterialPack& pack);

// Throws std::runtime_error "FILE: PART: found …; REMEDY".
MaterialPack ReadMaterialPack(const std::filesystem::path& path);

// A window of `window` texels at (column, row), resampled to size × size texels by averaging;
// size ≤ window, and the window lies in the material. Texels are averaged in linear values, normals
// by their slopes.
SvbrdfMaps CutMaterial(const PackedMaterial& material, int column, int row, int window, int size);

}  // namespace glint
