// The material as a binary glTF 2.0 file (.glb): a plane of the sample's true size with its maps,
// which Blender, three.js, Godot, Unreal and Unity read as it is.
//
// glTF's dielectric has base colour and F0 = 0.04 · specularColor (KHR_materials_specular), which
// may be any colour; metalness is 0 throughout and metals are dielectrics of high F0. Its diffuse
// lobe is weighted by 1 − max(F); where Glint's is not (convention "diffuse=one"), base colour is
// divided by 1 − max(F0), so that both agree at normal incidence as far as base colour can reach 1.
//
// Of two specular lobes (base/reflectance/convention.h) the narrow one is a clear coat
// (KHR_materials_clearcoat), whose F0 is 0.04 times its strength: what a dielectric's narrow lobe
// reflects; where it is more, or coloured, the rest stays with the wide one.
#pragma once

#include <array>
#include <string>

#include "pipeline/export/export_maps.h"

namespace glint {

inline constexpr double kGltfF0 = 0.04;  // of glTF's default index of refraction, 1.5

// The file's bytes, the same for any number of threads. The plane lies in x and y about the origin
// and looks along +z; metres.
std::string GlbOf(const ExportedMaterial& material, int threads);

// The texel's specular lobes there.
struct GltfLobes {
  std::array<double, 3> f0{};
  double roughness = 0;   // α = its square, across the direction in which the lobe is wider
  double anisotropy = 0;  // strength s: along that direction α + (1 − α)s²
  double clearcoat = 0, clearcoat_roughness = 0;  // strength 0: none
};
GltfLobes GltfLobesOf(const ExportedMaterial& material, size_t texel);

// The texel's base colour there, linear, up to 1.
std::array<double, 3> GltfBaseColor(const ExportedMaterial& material, size_t texel);

}  // namespace glint
