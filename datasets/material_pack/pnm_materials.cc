#include "datasets/material_pack/pnm_materials.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <optional>
#include <stdexcept>

#include "base/colour/srgb.h"

namespace glint {
namespace {

namespace fs = std::filesystem;

// As datasets/map_formats reads folders of maps.
constexpr float kDielectricF0 = 0.04f;
constexpr float kSmallestRoughness = 0.5f / 255;
constexpr float kLeastNormalZ = 1e-3f;  // lossy compression leaves some below the horizon
constexpr int kLargestSide = 16384;

[[noreturn]] void Fail(const fs::path& path, const std::string& part, const std::string& found,
                       const std::string& remedy) {
  throw std::runtime_error(path.string() + ": " + part + ": found " + found + "; " + remedy);
}

struct Picture {
  int size = 0, channels = 0;
  std::vector<unsigned char> values;  // interleaved

  float At(size_t texel, int channel) const {
    const size_t c = static_cast<size_t>(std::min(channel, channels - 1));
    return static_cast<float>(values[texel * static_cast<size_t>(channels) + c]) / 255;
  }
};

// A header's next number; comments run from # to the end of the line.
int NextNumber(std::istream* in) {
  while (in->good() && (std::isspace(in->peek()) != 0 || in->peek() == '#')) {
    if (in->get() == '#') in->ignore(1 << 16, '\n');
  }
  int number = 0;
  *in >> number;
  return number;
}

Picture ReadPnm(const fs::path& path) {
  std::ifstream in(path, std::ios::binary);
  char magic[2] = {};
  in.read(magic, 2);
  if (!in || magic[0] != 'P' || (magic[1] != '5' && magic[1] != '6')) {
    Fail(path, "header", "no binary PNM", "write P5 or P6, as djpeg -pnm does");
  }
  const int width = NextNumber(&in), height = NextNumber(&in), most = NextNumber(&in);
  in.get();  // the one blank before the values
  if (!in || width != height || width < 1 || width > kLargestSide) {
    Fail(path, "size", std::to_string(width) + "x" + std::to_string(height),
         "give square maps of at most 16384 texels");
  }
  if (most != 255) Fail(path, "maximum", std::to_string(most), "give 8-bit pictures");
  Picture picture{width, magic[1] == '6' ? 3 : 1, {}};
  picture.values.resize(static_cast<size_t>(width) * height *
                        static_cast<size_t>(picture.channels));
  in.read(reinterpret_cast<char*>(picture.values.data()),
          static_cast<std::streamsize>(picture.values.size()));
  if (!in) Fail(path, "values", "fewer than its size says", "convert the picture again");
  return picture;
}

std::optional<Picture> ReadMap(const fs::path& folder, const std::string& kind) {
  for (const auto& entry : fs::directory_iterator(folder)) {
    const std::string extension = entry.path().extension();
    if (extension != ".ppm" && extension != ".pgm") continue;
    if (entry.path().stem().string().ends_with("_" + kind)) return ReadPnm(entry.path());
  }
  return std::nullopt;
}

Picture RequireMap(const fs::path& folder, const std::string& kind, int size) {
  std::optional<Picture> picture = ReadMap(folder, kind);
  if (!picture) {
    Fail(folder, kind, "no file named *_" + kind, "put NAME_" + kind + ".ppm or .pgm there");
  }
  if (size > 0 && picture->size != size) {
    Fail(folder, kind, std::to_string(picture->size) + " texels a side",
         "the colour map has " + std::to_string(size) + "; give all maps the same size");
  }
  return *std::move(picture);
}

void StoreNormal(const Picture& normal, size_t texel, SvbrdfMaps* maps) {
  const float x = 2 * normal.At(texel, 0) - 1, y = 2 * normal.At(texel, 1) - 1;
  const float z = std::max(2 * normal.At(texel, 2) - 1, kLeastNormalZ);
  const float length = std::sqrt(x * x + y * y + z * z);
  maps->plane(kNormalX)[texel] = x / length;
  maps->plane(kNormalY)[texel] = y / length;
  maps->plane(kNormalZ)[texel] = z / length;
}

}  // namespace

PackedMaterial ReadPnmMaterial(const fs::path& folder, int size) {
  const Picture color = RequireMap(folder, "Color", 0);
  const Picture normal = RequireMap(folder, "NormalGL", color.size);
  const Picture roughness = RequireMap(folder, "Roughness", color.size);
  const std::optional<Picture> metalness = ReadMap(folder, "Metalness");
  if (color.size < size) {
    Fail(folder, "size", std::to_string(color.size) + " texels a side",
         "packs have " + std::to_string(size) + "; give larger maps or a smaller --size");
  }
  SvbrdfMaps maps(color.size, color.size);
  for (size_t i = 0; i < maps.texels(); ++i) {
    StoreNormal(normal, i, &maps);
    maps.plane(kRoughness)[i] = std::clamp(roughness.At(i, 0), kSmallestRoughness, 1.0f);
    const float metal = metalness ? metalness->At(i, 0) : 0.0f;
    for (int c = 0; c < 3; ++c) {
      const float base = LinearFromSrgb(color.At(i, c));
      maps.plane(kDiffuseR + c)[i] = base * (1 - metal);
      maps.plane(kSpecularR + c)[i] = kDielectricF0 * (1 - metal) + base * metal;
    }
  }
  const std::string name = fs::absolute(folder).lexically_normal().filename();
  PackedMaterial packed = PackMaterial(name, maps);
  if (color.size == size) return packed;
  return PackMaterial(name, CutMaterial(packed, 0, 0, color.size, size));
}

}  // namespace glint
