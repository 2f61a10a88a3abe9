// What a PNG is made of, for OpenImageIO. Included by .cc files only.
#pragma once

#include <OpenImageIO/imageio.h>

#include <cstdint>
#include <vector>

#include "base/images/image.h"

namespace glint {

OIIO::ImageSpec PngSpec(int width, int height, int channels, int bits, const PngTags& tags);

// Values of an image clamped to [0, 1], rounded to 8 or 16 bits, interleaved.
class PngSamples {
 public:
  PngSamples(const Image& image, int bits);
  OIIO::TypeDesc type() const { return bits_ == 16 ? OIIO::TypeUInt16 : OIIO::TypeUInt8; }
  const void* data() const {
    return bits_ == 16 ? static_cast<const void*>(words_.data()) : bytes_.data();
  }

 private:
  int bits_;
  std::vector<std::uint16_t> words_;
  std::vector<std::uint8_t> bytes_;
};

}  // namespace glint
