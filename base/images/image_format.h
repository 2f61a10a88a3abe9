// The formats of images that Glint reads: one row each in image_format.cc.
#pragma once

#include <filesystem>
#include <string>

namespace glint {

// OpenImageIO's name of the reader for a file: "jpeg", "png", "tiff", "openexr", "heif", "raw",
// "hdr", "pnm"; "": none. The first bytes decide, whatever the file is called; RAW formats, many of
// which begin as TIFF files do, are told by their names too. No other reader ever sees the file:
// OpenImageIO itself would offer it to thirty, and a damaged file crashes some of them.
std::string ReaderOf(const std::filesystem::path& file);

// Whether the file name's ending is that of a photograph: JPEG, PNG, TIFF, EXR, HEIF, RAW. What is
// taken for a photograph in a folder.
bool IsPhotoFileName(const std::filesystem::path& file);

// Whether the file name's ending is that of a camera's RAW format (DNG, CR2, NEF…).
bool IsRawFileName(const std::filesystem::path& file);

}  // namespace glint
