// Small pictures of photographs, for lists.
#pragma once

#include <filesystem>
#include <string>

#include "base/photos/photo.h"

namespace glint {

// As a JPEG of 320 px.
std::string SmallJpeg(const StoredImage& image);

// Of a photograph, of which no more is read than that takes. Throws Error for what is none.
std::string SmallJpegOf(const std::filesystem::path& photo);

}  // namespace glint
