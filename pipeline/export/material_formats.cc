#include "pipeline/export/material_formats.h"

#include <algorithm>
#include <numbers>

#include "base/errors/errors.h"
#include "pipeline/export/blender_script.h"
#include "pipeline/export/gltf_material.h"
#include "pipeline/export/materialx_material.h"
#include "pipeline/export/usd_material.h"

namespace glint {
namespace {

using Rgb = std::array<double, 3>;

Rgb Specular(const ExportedMaterial& material, size_t texel) {
  Rgb rgb;
  for (int c = 0; c < 3; ++c) {
    rgb[static_cast<size_t>(c)] = material.maps.plane(kSpecularR + c)[texel];
  }
  return rgb;
}

// The albedo of a diffuse lobe that nothing weights.
Rgb Diffuse(const ExportedMaterial& material, size_t texel) {
  const Rgb specular = Specular(material, texel);
  const bool whole = material.convention.diffuse_weight == DiffuseWeight::kOne;
  Rgb rgb;
  for (size_t c = 0; c < 3; ++c) {
    const double albedo = material.maps.plane(kDiffuseR + static_cast<int>(c))[texel];
    rgb[c] = whole ? albedo : albedo * (1 - specular[c]);
  }
  return rgb;
}

// Diffuse and specular lobes that are added, Schlick's Fresnel by the cosine given.
Rgb Added(const ExportedMaterial& material, size_t texel, const DirectionPair& pair,
          double cosine) {
  const Rgb diffuse = Diffuse(material, texel), specular = Specular(material, texel);
  const double roughness = material.maps.plane(kRoughness)[texel], weight = SchlickWeight(cosine);
  const double lobe = SmithSpecular(pair, roughness, material.convention.lobes);
  const double coat = SmithCoat(pair, roughness, material.convention.lobes, weight);
  Rgb brdf;
  for (size_t c = 0; c < 3; ++c) {
    brdf[c] =
        diffuse[c] / std::numbers::pi + lobe * (specular[c] + (1 - specular[c]) * weight) + coat;
  }
  return brdf;
}

// Diffuse under a Fresnel layer: base·(1 − F)/π + lobe·F, F of each channel or the largest.
Rgb Layered(const Rgb& base, const Rgb& f0, double lobe, const DirectionPair& pair, bool largest) {
  const double weight = SchlickWeight(pair.v_dot_h);
  Rgb fresnel, brdf;
  for (size_t c = 0; c < 3; ++c) fresnel[c] = f0[c] + (1 - f0[c]) * weight;
  const double most = *std::max_element(fresnel.begin(), fresnel.end());
  for (size_t c = 0; c < 3; ++c) {
    brdf[c] = base[c] * (1 - (largest ? most : fresnel[c])) / std::numbers::pi + lobe * fresnel[c];
  }
  return brdf;
}

Rgb GltfBrdf(const ExportedMaterial& material, size_t texel, const DirectionPair& pair) {
  const GltfLobes lobes = GltfLobesOf(material, texel);
  const double across = WidthsOf(lobes.roughness, {}).across;
  const LobeWidths widths = {across + (1 - across) * lobes.anisotropy * lobes.anisotropy, across,
                             material.convention.lobes.anisotropy.direction_deg};
  Rgb brdf =
      Layered(GltfBaseColor(material, texel), lobes.f0, SmithSpecular(pair, widths), pair, true);
  if (lobes.clearcoat == 0) return brdf;
  const double coat = lobes.clearcoat * (kGltfF0 + (1 - kGltfF0) * SchlickWeight(pair.camera[2]));
  const double lobe = SmithSpecular(pair, lobes.clearcoat_roughness);
  for (double& f : brdf) f = (1 - coat) * f + coat * lobe;
  return brdf;
}

Rgb UsdBrdf(const ExportedMaterial& material, size_t texel, const DirectionPair& pair) {
  return Layered(LayeredDiffuse(material, texel), Specular(material, texel),
                 SmithSpecular(pair, material.maps.plane(kRoughness)[texel]), pair, false);
}

// A file that only refers to maps takes no time.
template <auto kTextOf>
std::string Text(const ExportedMaterial& material,
                 const std::function<std::string(const std::string& map)>& file_of, int) {
  return kTextOf(material, file_of);
}

}  // namespace

const std::vector<MaterialFormat>& MaterialFormats() {
  static const std::vector<MaterialFormat> formats = {
      {"gltf", ".glb",
       [](const ExportedMaterial& material, const auto&, int threads) {
         return GlbOf(material, threads);
       },
       GltfBrdf},
      {"materialx", ".mtlx", Text<MaterialXOf>,
       [](const ExportedMaterial& material, size_t texel, const DirectionPair& pair) {
         return Added(material, texel, pair, pair.v_dot_h);
       }},
      {"usd", ".usda", Text<UsdOf>, UsdBrdf},
      {"blender", "_blender.py", Text<BlenderScriptOf>,
       [](const ExportedMaterial& material, size_t texel, const DirectionPair& pair) {
         return Added(material, texel, pair, pair.camera[2]);
       }},
  };
  return formats;
}

std::string MaterialFormatNames() {
  std::string names;
  for (const MaterialFormat& format : MaterialFormats()) {
    names += (names.empty() ? "" : ", ") + format.name;
  }
  return names;
}

std::vector<MaterialFormat> ChosenFormats(const std::vector<std::string>& names) {
  if (names.empty()) return MaterialFormats();
  std::vector<MaterialFormat> chosen;
  for (const std::string& name : names) {
    const auto& all = MaterialFormats();
    const auto found = std::find_if(all.begin(), all.end(),
                                    [&](const MaterialFormat& f) { return f.name == name; });
    if (found == all.end()) {
      throw UserError("--formats: '" + name + "' is not a material format: give one or more of " +
                      MaterialFormatNames());
    }
    chosen.push_back(*found);
  }
  return chosen;
}

}  // namespace glint
