#include "pipeline/export/export_maps.h"

#include <algorithm>
#include <cmath>

#include "pipeline/export/material_formats.h"

namespace glint {
namespace {

const std::vector<std::string> kRgb = {"R", "G", "B"};
const std::vector<std::string> kGrey = {"Y"};

MapPicture ColorPicture(const std::string& name, const SvbrdfMaps& maps, int first_plane,
                        const std::string& folder) {
  MapPicture picture{name, "sRGB", Image(maps.width, maps.height, kRgb), folder};
  for (int c = 0; c < 3; ++c) {
    const auto from = maps.plane(first_plane + c);
    std::transform(from.begin(), from.end(), picture.image.channel(c).begin(), SrgbFromLinear);
  }
  return picture;
}

MapPicture LayeredDiffusePicture(const ExportedMaterial& material) {
  MapPicture picture{"diffuse_layered", "sRGB",
                     Image(material.maps.width, material.maps.height, kRgb), "exact/"};
  for (size_t i = 0; i < material.maps.texels(); ++i) {
    const std::array<double, 3> albedo = LayeredDiffuse(material, i);
    for (int c = 0; c < 3; ++c) {
      picture.image.channel(c)[i] =
          SrgbFromLinear(static_cast<float>(albedo[static_cast<size_t>(c)]));
    }
  }
  return picture;
}

MapPicture BaseColorPicture(const MetalRoughness& metal) {
  MapPicture picture{"basecolor", "sRGB", Image(metal.width, metal.height, kRgb)};
  std::transform(metal.base_color.begin(), metal.base_color.end(), picture.image.samples.begin(),
                 SrgbFromLinear);
  return picture;
}

template <class Values>
MapPicture GreyPicture(const std::string& name, int width, int height, const Values& values) {
  MapPicture picture{name, "linear", Image(width, height, kGrey)};
  std::copy(values.begin(), values.end(), picture.image.channel(0).begin());
  return picture;
}

MapPicture NormalPicture(const SvbrdfMaps& maps, const std::string& name, float y_sign) {
  MapPicture picture{name, y_sign > 0 ? "normal +Y" : "normal -Y",
                     Image(maps.width, maps.height, kRgb)};
  for (int c = 0; c < 3; ++c) {
    const float half = c == 1 ? 0.5f * y_sign : 0.5f;
    const auto from = maps.plane(kNormalX + c);
    std::transform(from.begin(), from.end(), picture.image.channel(c).begin(),
                   [half](float n) { return std::clamp(half * n + 0.5f, 0.0f, 1.0f); });
  }
  return picture;
}

template <class Red, class Green, class Blue>
MapPicture PackedPicture(const std::string& name, int width, int height, const Red& red,
                         const Green& green, const Blue& blue) {
  MapPicture picture{name, "linear", Image(width, height, kRgb)};
  std::copy(red.begin(), red.end(), picture.image.channel(0).begin());
  std::copy(green.begin(), green.end(), picture.image.channel(1).begin());
  std::copy(blue.begin(), blue.end(), picture.image.channel(2).begin());
  return picture;
}

}  // namespace

void AddExportOptions(OptionSet* set, ExportOptions* options) {
  set->Add("name", &options->name, "what the files' names begin with");
  set->AddChoice("from", &options->from, {"refine", "fit", "tile"}, "stage whose maps are exported");
  set->AddChoice("bits", &options->bits, {"8", "16", "both"},
                 "bits a channel of the pictures; the height always has 16");
  set->AddRange(
      "height-longest", &options->height_longest, 0, 100,
      "longest waves that the height map keeps, of the sample's shorter side; longer ones are "
      "mostly bowls from shared errors of normals; 0: all");
  set->AddRange("occlusion-reach", &options->occlusion_reach, 0.001, 1,
                "how far relief hides the sky from ambient occlusion, of the shorter side");
  set->AddRange("metal-radius", &options->metal.radius, 0, 64,
                "radius, in texels, of like-coloured neighbours that decide metalness together");
  set->AddRange("metal-colour-width", &options->metal.colour_width, 0.001, 10,
                "by how much colours (square roots of albedos) may differ for that");
  set->AddRange("metal-blend-cost", &options->metal.blend_cost, 0, 1,
                "what metalness 1/2 costs beside 0 and 1, of log radiance");
  set->Add("formats", &options->formats,
           "material files to write: " + MaterialFormatNames() + " (default: all)");
}

std::array<double, 2> HeightRange(const HeightField& field) {
  const auto [low, high] = std::minmax_element(field.height_mm.begin(), field.height_mm.end());
  return {*low, *high};
}

MapPicture HeightPicture(const HeightField& field, const std::array<double, 2>& range_mm) {
  MapPicture picture{"height", "linear", Image(field.width, field.height, kGrey), "", 16};
  const double range = std::max(range_mm[1] - range_mm[0], 1e-6);
  std::transform(field.height_mm.begin(), field.height_mm.end(), picture.image.channel(0).begin(),
                 [&](float h) { return static_cast<float>((h - range_mm[0]) / range); });
  return picture;
}

float SrgbFromLinear(float linear) {
  const float v = std::clamp(linear, 0.0f, 1.0f);
  return v <= 0.0031308f ? 12.92f * v : 1.055f * std::pow(v, 1 / 2.4f) - 0.055f;
}

std::array<double, 3> LayeredDiffuse(const ExportedMaterial& material, size_t texel) {
  const bool whole = material.diffuse_weight == DiffuseWeight::kOne;
  std::array<double, 3> albedo;
  for (int c = 0; c < 3; ++c) {
    const double f0 = material.maps.plane(kSpecularR + c)[texel];
    const double left = whole ? std::max(1e-3, 1 - f0) : 1;
    albedo[static_cast<size_t>(c)] =
        std::clamp(material.maps.plane(kDiffuseR + c)[texel] / left, 0.0, 1.0);
  }
  return albedo;
}

std::vector<MapPicture> MapPictures(const ExportedMaterial& material, const HeightField& relief,
                                    const std::vector<float>& occlusion) {
  const SvbrdfMaps& maps = material.maps;
  const MetalRoughness& metal = material.metal;
  const auto roughness = maps.plane(kRoughness);
  std::vector<MapPicture> pictures;
  pictures.push_back(BaseColorPicture(metal));
  pictures.push_back(GreyPicture("metallic", maps.width, maps.height, metal.metallic));
  pictures.push_back(GreyPicture("roughness", maps.width, maps.height, roughness));
  pictures.push_back(NormalPicture(maps, "normal_gl", 1));
  pictures.push_back(NormalPicture(maps, "normal_dx", -1));
  pictures.push_back(HeightPicture(relief, material.height_range_mm));
  pictures.push_back(GreyPicture("ao", maps.width, maps.height, occlusion));
  pictures.push_back(
      PackedPicture("orm", maps.width, maps.height, occlusion, roughness, metal.metallic));
  pictures.push_back(ColorPicture("diffuse", maps, kDiffuseR, "exact/"));
  pictures.push_back(ColorPicture("specular", maps, kSpecularR, "exact/"));
  pictures.push_back(LayeredDiffusePicture(material));
  return pictures;
}

std::string FileOf(const std::string& name, const MapPicture& picture) {
  return picture.folder + name + "_" + picture.map + ".png";
}

Json WriteMapPictures(const ExportedMaterial& material, const std::vector<MapPicture>& pictures,
                      const ExportOptions& options, Stage* stage) {
  const double texels_per_m = 1000 * material.maps.width / material.width_mm;
  Json files = Json::array();
  for (const MapPicture& picture : pictures) {
    for (const int bits : {8, 16}) {
      const bool wanted = picture.bits > 0
                              ? picture.bits == bits
                              : options.bits == "both" || options.bits == std::to_string(bits);
      if (!wanted) continue;
      const bool apart = bits == 16 && picture.bits == 0 && options.bits == "both";
      const std::string file = (apart ? "16bit/" : "") + FileOf(material.name, picture);
      WritePng(
          stage->Output(file), picture.image, bits,
          {picture.encoding == "sRGB" ? PngTransfer::kSrgb : PngTransfer::kUntold, texels_per_m});
      Json entry = {
          {"file", file}, {"map", picture.map}, {"encoding", picture.encoding}, {"bits", bits}};
      if (picture.map == "height") entry["range_mm"] = material.height_range_mm;
      files.push_back(entry);
    }
  }
  return files;
}

}  // namespace glint
