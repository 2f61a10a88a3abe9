// Materials for packs from uncompressed pictures, where no library reads others: on the machine
// that trains. No torch in this header.
#pragma once

#include <filesystem>

#include "datasets/material_pack/material_pack.h"

namespace glint {

// The material of a folder of maps named the ambientCG way, as binary PNM (P5, P6) of 8 bits:
// *_Color, *_NormalGL, *_Roughness, and *_Metalness, if there is one, each .ppm or .pgm, square and
// of one size. Read as `glint-synth pack` reads them: sRGB colours, dielectrics of F0 0.04. Larger
// ones are averaged to size × size texels. Throws std::runtime_error "FILE: PART: found …; REMEDY".
PackedMaterial ReadPnmMaterial(const std::filesystem::path& folder, int size);

}  // namespace glint
