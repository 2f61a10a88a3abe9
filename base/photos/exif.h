// What a file tells of how it was taken. Included by .cc files only.
#pragma once

#include <OpenImageIO/imageio.h>

#include <filesystem>
#include <string_view>

#include "base/photos/photo.h"

namespace glint {

// How the picture must be turned to be upright, as EXIF's orientation 1 … 8, and whether the
// decoder has turned it already: LibRaw does for RAW, libheif for HEIC.
struct Orientation {
  int exif = 1;
  bool applied = false;
};
Orientation OrientationOf(const std::filesystem::path& file, const OIIO::ImageInput& input);

// Fills everything but image, bits, orientation and colour.
void ReadExif(const OIIO::ImageSpec& spec, std::string_view format, Photo* photo);

}  // namespace glint
