#include "pipeline/export/export_maps.h"

#include <algorithm>
#include <cmath>

#include "pipeline/export/metallic.h"

namespace glint {
namespace {

const std::vector<std::string> kRgb = {"R", "G", "B"};
const std::vector<std::string> kGrey = {"Y"};

MapPicture ColorPicture(const std::string& name, const SvbrdfMaps& maps, int first_plane) {
  MapPicture picture{name, "sRGB", Image(maps.width, maps.height, kRgb)};
  for (int c = 0; c < 3; ++c) {
    const auto from = maps.plane(first_plane + c);
    std::transform(from.begin(), from.end(), picture.image.channel(c).begin(), SrgbFromLinear);
  }
  return picture;
}

MapPicture NormalPicture(const SvbrdfMaps& maps, const std::string& normal_y) {
  MapPicture picture{"normal", "normal " + normal_y + "Y", Image(maps.width, maps.height, kRgb)};
  for (int c = 0; c < 3; ++c) {
    const float sign = c == 1 && normal_y == "-" ? -0.5f : 0.5f;
    const auto from = maps.plane(kNormalX + c);
    std::transform(from.begin(), from.end(), picture.image.channel(c).begin(),
                   [sign](float n) { return std::clamp(sign * n + 0.5f, 0.0f, 1.0f); });
  }
  return picture;
}

MapPicture RoughnessPicture(const SvbrdfMaps& maps) {
  MapPicture picture{"roughness", "linear", Image(maps.width, maps.height, kGrey)};
  const auto from = maps.plane(kRoughness);
  std::copy(from.begin(), from.end(), picture.image.channel(0).begin());
  return picture;
}

void AddMetallicPictures(const SvbrdfMaps& maps, std::vector<MapPicture>* pictures) {
  MapPicture base{"basecolor", "sRGB", Image(maps.width, maps.height, kRgb)};
  MapPicture metallic{"metallic", "linear", Image(maps.width, maps.height, kGrey)};
  for (size_t i = 0; i < maps.texels(); ++i) {
    std::array<float, 3> diffuse, specular;
    for (int c = 0; c < 3; ++c) {
      diffuse[static_cast<size_t>(c)] = maps.plane(kDiffuseR + c)[i];
      specular[static_cast<size_t>(c)] = maps.plane(kSpecularR + c)[i];
    }
    const BaseColorMetallic converted = ToBaseColorMetallic(diffuse, specular);
    for (int c = 0; c < 3; ++c) {
      base.image.channel(c)[i] = SrgbFromLinear(converted.base_color[static_cast<size_t>(c)]);
    }
    metallic.image.channel(0)[i] = converted.metallic;
  }
  pictures->push_back(std::move(base));
  pictures->push_back(std::move(metallic));
}

}  // namespace

void AddExportOptions(OptionSet* set, ExportOptions* options) {
  set->AddChoice("from", &options->from, {"refine", "fit"}, "stage whose maps are exported");
  set->AddChoice("bits", &options->bits, {"8", "16", "both"}, "bits a channel");
  set->AddChoice("normal-y", &options->normal_y, {"+", "-"},
                 "direction of green in the normal map: + OpenGL, - DirectX");
  set->Add("metallic", &options->metallic, "base colour and metalness as well");
  set->Add("height", &options->height, "height map, 16 bits, integrated from the normals");
  set->AddRange(
      "height-longest", &options->height_longest, 0, 100,
      "longest waves that the height map keeps, of the sample's shorter side; small errors "
      "that normals share make bowls of longer ones; 0: all");
  set->Add("gltf", &options->gltf,
           "the material on a plane of its true size, as a glTF file (.glb)");
}

MapPicture HeightPicture(const HeightField& field, std::array<double, 2>* range_mm) {
  MapPicture picture{"height", "linear", Image(field.width, field.height, kGrey)};
  const auto [low, high] = std::minmax_element(field.height_mm.begin(), field.height_mm.end());
  *range_mm = {*low, *high};
  const float range = std::max(*high - *low, 1e-6f);
  std::transform(field.height_mm.begin(), field.height_mm.end(), picture.image.channel(0).begin(),
                 [&](float h) { return (h - *low) / range; });
  return picture;
}

float SrgbFromLinear(float linear) {
  const float v = std::clamp(linear, 0.0f, 1.0f);
  return v <= 0.0031308f ? 12.92f * v : 1.055f * std::pow(v, 1 / 2.4f) - 0.055f;
}

std::vector<MapPicture> MapPictures(const SvbrdfMaps& maps, const ExportOptions& options) {
  std::vector<MapPicture> pictures;
  pictures.push_back(NormalPicture(maps, options.normal_y));
  pictures.push_back(ColorPicture("diffuse", maps, kDiffuseR));
  pictures.push_back(ColorPicture("specular", maps, kSpecularR));
  pictures.push_back(RoughnessPicture(maps));
  if (options.metallic) AddMetallicPictures(maps, &pictures);
  return pictures;
}

Json WriteMapPictures(const std::vector<MapPicture>& pictures, const ExportOptions& options,
                      Stage* stage) {
  Json files = Json::array();
  for (const MapPicture& picture : pictures) {
    for (const int bits : {8, 16}) {
      if (options.bits != "both" && options.bits != std::to_string(bits)) continue;
      const std::string file = (bits == 16 ? "16bit/" : "") + picture.name + ".png";
      WritePng(stage->Output(file), picture.image, bits);
      files.push_back(
          {{"file", file}, {"map", picture.name}, {"encoding", picture.encoding}, {"bits", bits}});
    }
  }
  return files;
}

}  // namespace glint
