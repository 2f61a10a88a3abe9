// What a photograph's header tells, without its pixels.
#pragma once

#include <filesystem>

#include "base/photos/photo.h"

namespace glint {

struct PhotoHeader {
  Photo photo;  // EXIF alone; its image is empty
  bool is_jpeg = false;
  int stored_width = 0, stored_height = 0;  // before the orientation is applied
};

// Throws UserError as ReadPhoto does, for what the header shows.
PhotoHeader ReadPhotoHeader(const std::filesystem::path& file);

}  // namespace glint
