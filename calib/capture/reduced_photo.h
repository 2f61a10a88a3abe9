// Photographs at a fraction of their size, for a quick look.
#pragma once

#include <filesystem>

#include "base/photos/photo.h"

namespace glint {

// The photograph shrunk by 1, 2, 4 or 8, the least that brings its longer side to at most
// `longest_px`; `reduction` returns it. libjpeg leaves out the finest frequencies while decoding,
// which takes a third of the time. Files other than JPEG are read whole and not shrunk. The point
// (x, y) of the photograph is (x, y) / reduction here. Throws UserError as ReadPhoto does.
Photo ReadReducedPhoto(const std::filesystem::path& file, int longest_px, int* reduction);

}  // namespace glint
