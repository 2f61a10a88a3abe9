// How a HEIC picture is turned for showing.
#pragma once

#include <filesystem>
#include <string_view>

namespace glint {

// EXIF orientation (1 … 8) that equals the transformations `irot` and `imir` of the primary
// picture. A HEIC's own orientation is these (ISO/IEC 23008-12, 6.5.10 and 6.5.12); libheif applies
// them and, before 1.16, tells nobody (1.15, Debian 12's, has no call for them), and EXIF's tag is
// a copy at best. 1 where the file has none or is no HEIC.
int HeicOrientation(const std::filesystem::path& file);

// The same for the first bytes of a file. Never reads beyond them.
int HeicOrientation(std::string_view bytes);

}  // namespace glint
