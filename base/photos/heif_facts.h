// What a HEIC file says beside its picture, by libheif.
#pragma once

#include <filesystem>
#include <string>

#include "base/photos/colour_profile.h"

namespace glint {

struct HeifFacts {
  ColourProfile colour;  // of an ICC profile or of the primaries that are named
  std::string exif;      // the EXIF block from its TIFF header on; empty: none
};

// Nothing where the file is none or is damaged.
HeifFacts ReadHeifFacts(const std::filesystem::path& file);

}  // namespace glint
