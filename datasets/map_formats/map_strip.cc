#include "datasets/map_formats/map_strip.h"

#include "base/errors/errors.h"
#include "base/images/image.h"
#include "base/photos/photo.h"
#include "datasets/map_formats/map_values.h"

namespace glint {
namespace {

// One tile of the strip as three planes.
class Tile {
 public:
  Tile(const Image& strip, int index) : strip_(strip), first_column_(index * strip.height) {}
  float At(int channel, int row, int column) const {
    return strip_.channel(
        channel)[static_cast<size_t>(row) * strip_.width + first_column_ + column];
  }

 private:
  const Image& strip_;
  int first_column_;
};

void StoreAlbedo(const Tile& tile, Encoding encoding, int first_plane, SvbrdfMaps* maps) {
  for (int c = 0; c < 3; ++c) {
    for (int row = 0; row < maps->height; ++row) {
      for (int column = 0; column < maps->width; ++column) {
        const float value = LinearFromEncoded(encoding, tile.At(c, row, column));
        maps->at(first_plane + c, row, column) = std::min(value, 1.0f);
      }
    }
  }
}

}  // namespace

SvbrdfMaps ReadMapStrip(const std::filesystem::path& file, MapLayout layout,
                        const MapEncodings& encodings) {
  const bool with_photo = layout == MapLayout::kPhotoStrip;
  const int tiles = with_photo ? 5 : 4;
  const Image strip = ReadPhoto(file).image.Planes();
  if (strip.width != tiles * strip.height) {
    throw UserError(file, "size", std::to_string(strip.width) + "x" + std::to_string(strip.height),
                    "this strip must be " + std::to_string(tiles) + " square maps wide");
  }
  const int first = with_photo ? 1 : 0;
  const Tile normal(strip, first), diffuse(strip, first + 1), roughness(strip, first + 2),
      specular(strip, first + 3);
  SvbrdfMaps maps(strip.height, strip.height);
  for (int row = 0; row < maps.height; ++row) {
    for (int column = 0; column < maps.width; ++column) {
      const size_t texel = static_cast<size_t>(row) * maps.width + column;
      StoreNormal(normal.At(0, row, column), normal.At(1, row, column), normal.At(2, row, column),
                  texel, &maps);
      StoreRoughness(roughness.At(0, row, column), texel, &maps);
    }
  }
  StoreAlbedo(diffuse,
              encodings.diffuse.value_or(with_photo ? Encoding::kLinear : Encoding::kGamma22),
              kDiffuseR, &maps);
  StoreAlbedo(specular, encodings.specular.value_or(Encoding::kLinear), kSpecularR, &maps);
  return maps;
}

}  // namespace glint
