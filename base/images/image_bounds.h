// Bounds on what untrusted image files may make their readers allocate.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>

namespace glint {

// Largest image that is read (pixels); larger ones are refused before they are allocated.
inline constexpr std::size_t kMaxPixels = 512u << 20;
inline constexpr int kMaxImageChannels = 64;
// OpenEXR makes a table with an entry for every line of an image before anyone sees its size
// (Imf::Header::setMaxImageSize).
inline constexpr int kMostExrSide_px = 1 << 17;

struct ImageSize {
  int width = 0, height = 0, channels = 0;
};

// Throws UserError: missing, empty, or an EXR or PNG in which a length exceeds the file. OpenEXR
// and libpng allocate what a length says, up to 2 GiB, before they look for the bytes. What a file
// is called does not matter: its first bytes choose its reader.
void RequireImageFile(const std::filesystem::path& file);

// Throws UserError: no pixels, more than kMaxPixels, more than kMaxImageChannels.
void RequireSize(const std::filesystem::path& file, const ImageSize& size);

// Throws UserError where so many rows need more memory than allowed: a small file may ask for a
// large image.
void RequireMemoryForRows(const std::filesystem::path& file, const ImageSize& size, int rows);

// An image that ends early or is damaged, by a library's words. Throws UserError.
[[noreturn]] void RejectTruncated(const std::filesystem::path& file, std::string reason);

}  // namespace glint
