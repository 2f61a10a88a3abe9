// What a file tells of how it was taken. Included by .cc files only.
#pragma once

#include <OpenImageIO/imageio.h>

#include <filesystem>

#include "pipeline/photos/photo.h"

namespace glint {

// How the picture must be turned to be upright, as EXIF's orientation 1 … 8, and whether the
// decoder has turned it already: LibRaw does for RAW, libheif for HEIC.
struct Orientation {
  int exif = 1;
  bool applied = false;
};
Orientation OrientationOf(const std::filesystem::path& file, const OIIO::ImageInput& input);

// Fills everything but image, bits and orientation.
void ReadExif(const OIIO::ImageInput& input, Photo* photo);

}  // namespace glint
