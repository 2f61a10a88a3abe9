#include "pipeline/export/export_maps.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "base/colour/srgb.h"
#include "base/images/exr_rows.h"
#include "base/images/png_rows.h"
#include "base/parallel/parallel.h"
#include "base/reflectance/border.h"
#include "base/stages/stages.h"
#include "pipeline/export/material_formats.h"

namespace glint {
namespace {

const std::vector<std::string> kGrey = {"Y"};

MapPicture ColorPicture(const std::string& name, const SvbrdfMaps& maps, int first_plane,
                        const std::string& folder) {
  MapPicture picture{name, "sRGB", Image(maps.width, maps.height, kRgbChannels), folder};
  for (int c = 0; c < 3; ++c) {
    const auto from = maps.plane(first_plane + c);
    std::transform(from.begin(), from.end(), picture.image.channel(c).begin(), ClampedSrgb<float>);
  }
  return picture;
}

MapPicture LayeredDiffusePicture(const ExportedMaterial& material) {
  MapPicture picture{"diffuse_layered", "sRGB",
                     Image(material.maps.width, material.maps.height, kRgbChannels), "exact/"};
  for (size_t i = 0; i < material.maps.texels(); ++i) {
    const std::array<double, 3> albedo = LayeredDiffuse(material, i);
    for (int c = 0; c < 3; ++c) {
      picture.image.channel(c)[i] = ClampedSrgb(static_cast<float>(albedo[static_cast<size_t>(c)]));
    }
  }
  return picture;
}

MapPicture BaseColorPicture(const MetalRoughness& metal) {
  MapPicture picture{"basecolor", "sRGB", Image(metal.width, metal.height, kRgbChannels)};
  std::transform(metal.base_color.begin(), metal.base_color.end(), picture.image.samples.begin(),
                 ClampedSrgb<float>);
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
                     Image(maps.width, maps.height, kRgbChannels)};
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
  MapPicture picture{name, "linear", Image(width, height, kRgbChannels)};
  std::copy(red.begin(), red.end(), picture.image.channel(0).begin());
  std::copy(green.begin(), green.end(), picture.image.channel(1).begin());
  std::copy(blue.begin(), blue.end(), picture.image.channel(2).begin());
  return picture;
}

}  // namespace

void AddExportOptions(OptionSet* set, ExportOptions* options) {
  set->Add("name", &options->name, "prefix of the file names");
  set->AddChoice("from", &options->from, StagesWithMaps(ReadsMaps::kAny),
                 "stage whose maps to export");
  set->AddChoice("bits", &options->bits, {"8", "16", "both", "exr"},
                 "bits per channel of the PNG files (the height map is always 16-bit); both: 8 and "
                 "16; exr: 8, plus linear float32 EXR files in the folder exr/");
  set->AddRange(
      "border", &options->border, 0, kMostBorderRings,
      "number of outermost rings of texels to replace with the nearest inner texels, since they "
      "may include the sample's surroundings; 0: none; ignored for tiles");
  set->AddRange(
      "height-longest", &options->height_longest, 0, 100,
      "longest wavelength kept in the height map, as a fraction of the sample's shorter side; "
      "longer ones are mostly spurious curvature from systematic errors in the normals; 0: all");
  set->AddRange("occlusion-reach", &options->occlusion_reach, 0.001, 1,
                "search radius for ambient occlusion, as a fraction of the sample's shorter side");
  set->AddRange("material-size", &options->material_size, 16, 16384,
                "maximum side length, in texels, of the maps from which height, ambient occlusion "
                "and the textures in the .glb are made; larger ones are reduced by averaging");
  set->AddRange(
      "metal-radius", &options->metal.radius, 0, 64,
      "radius, in texels, within which texels of similar colour are classified jointly as "
      "metal or non-metal");
  set->AddRange("metal-colour-width", &options->metal.colour_width, 0.001, 10,
                "largest colour difference (square root of albedo) between texels that are "
                "classified jointly");
  set->AddRange("metal-blend-cost", &options->metal.blend_cost, 0, 1,
                "penalty on intermediate metalness, largest at 1/2, in units of log radiance");
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

std::array<double, 3> LayeredDiffuse(const ExportedMaterial& material, size_t texel) {
  const bool whole = material.convention.diffuse_weight == DiffuseWeight::kOne;
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

namespace {

constexpr int kExrBits = 32;

bool Wanted(const MapPicture& picture, int bits, const std::string& chosen) {
  if (bits == kExrBits) return chosen == "exr";
  if (picture.bits > 0) return picture.bits == bits;
  return chosen == "both" || chosen == std::to_string(bits) || (chosen == "exr" && bits == 8);
}

std::string NameOf(const std::string& material, const MapPicture& picture, int bits, bool apart) {
  const std::string png = FileOf(material, picture);
  if (bits == kExrBits)
    return "exr/" + std::filesystem::path(png).replace_extension(".exr").string();
  return (apart ? "16bit/" : "") + png;
}

std::string EncodingOf(const MapPicture& picture, int bits) {
  return bits == kExrBits && picture.encoding == "sRGB" ? "linear" : picture.encoding;
}

}  // namespace

// One picture at one depth.
struct MapFiles::File {
  size_t picture = 0;   // its place among the pictures
  bool linear = false;  // sRGB values are to be made linear
  std::optional<PngWriter> png;
  std::optional<ExrWriter> exr;

  void Write(const Image& rows) {
    if (png) return png->Write(rows);
    if (!linear) return exr->Write(rows);
    Image image = rows;
    std::transform(image.samples.begin(), image.samples.end(), image.samples.begin(),
                   LinearFromSrgb<float>);
    exr->Write(image);
  }
};

MapFiles::MapFiles(const ExportedMaterial& material, int width, int height,
                   const ExportOptions& options, Stage* stage)
    : material_(material), width_(width), height_(height), options_(options), stage_(stage) {}

MapFiles::~MapFiles() = default;

void MapFiles::Open(const std::vector<MapPicture>& pictures) {
  const double texels_per_m = 1000 * width_ / material_.width_mm;
  for (size_t i = 0; i < pictures.size(); ++i) {
    const MapPicture& picture = pictures[i];
    const bool srgb = picture.encoding == "sRGB";
    for (const int bits : {8, 16, kExrBits}) {
      if (!Wanted(picture, bits, options_.bits)) continue;
      const bool apart = bits == 16 && picture.bits == 0 && options_.bits == "both";
      const std::string name = NameOf(material_.name, picture, bits, apart);
      File& file = files_.emplace_back();
      file.picture = i;
      if (bits == kExrBits) {
        file.linear = srgb;
        file.exr.emplace(stage_->Output(name), width_, height_, picture.image.channels);
      } else {
        file.png.emplace(stage_->Output(name), width_, height_,
                         static_cast<int>(picture.image.channels.size()), bits,
                         PngTags{srgb ? PngTransfer::kSrgb : PngTransfer::kUntold, texels_per_m});
      }
      Json entry = {{"file", name},
                    {"map", picture.map},
                    {"encoding", EncodingOf(picture, bits)},
                    {"bits", bits}};
      if (picture.map == "height") entry["range_mm"] = material_.height_range_mm;
      entries_.push_back(entry);
    }
  }
}

void MapFiles::Write(const std::vector<MapPicture>& rows, int threads) {
  if (files_.empty()) Open(rows);
  ForEachPiece(static_cast<int>(files_.size()), threads, [&](int i) {
    File& file = files_[static_cast<size_t>(i)];
    file.Write(rows[file.picture].image);
  });
}

Json MapFiles::Close() {
  for (File& file : files_) {
    if (file.png) file.png->Close();
    if (file.exr) file.exr->Close();
  }
  return entries_;
}

Json WriteMapPictures(const ExportedMaterial& material, const std::vector<MapPicture>& pictures,
                      const ExportOptions& options, int threads, Stage* stage) {
  MapFiles files(material, material.maps.width, material.maps.height, options, stage);
  files.Write(pictures, threads);
  return files.Close();
}

}  // namespace glint
