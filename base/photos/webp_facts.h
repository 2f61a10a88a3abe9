// What a WebP file says beside its picture, by libwebp: OpenImageIO does not hand it on.
#pragma once

#include <filesystem>
#include <string>

namespace glint {

struct WebpFacts {
  std::string icc;   // profile; empty: none
  std::string exif;  // the EXIF block from its TIFF header on; empty: none
};

// Nothing where the file is none or is damaged.
WebpFacts ReadWebpFacts(const std::filesystem::path& file);

}  // namespace glint
