#include "pipeline/images/jpeg_segments.h"

#include <cstddef>

namespace glint {
namespace {

constexpr unsigned kJfif = 0xE0, kExif = 0xE1, kAdobe = 0xEE, kLastApp = 0xEF, kComment = 0xFE;
constexpr unsigned kStartOfScan = 0xDA, kEndOfImage = 0xD9;

// Markers that nothing follows: TEM, and RST0 … SOI.
bool StandsAlone(unsigned marker) {
  return marker == 0x01 || (marker >= 0xD0 && marker < kEndOfImage);
}

unsigned Byte(std::string_view bytes, std::size_t i) {
  return static_cast<unsigned char>(bytes[i]);
}

// `content`: what follows the segment's length.
bool IsNeeded(unsigned marker, std::string_view content) {
  using namespace std::string_view_literals;
  if (marker == kComment) return false;
  if (marker < kJfif || marker > kLastApp) return true;
  if (marker == kExif) return content.starts_with("Exif\0"sv);
  return marker == kJfif || marker == kAdobe;
}

}  // namespace

std::string WithPictureSegmentsAlone(std::string_view jpeg) {
  constexpr std::size_t kStartOfImage = 2, kMarkerAndLength = 4;
  std::string kept(jpeg.substr(0, kStartOfImage));
  std::size_t at = kStartOfImage;
  while (at + kMarkerAndLength <= jpeg.size()) {
    const unsigned marker = Byte(jpeg, at + 1);
    if (Byte(jpeg, at) != 0xFF || marker == 0 || marker == 0xFF) {
      ++at;  // decoders skip what stands between segments
      continue;
    }
    if (StandsAlone(marker)) {
      at += 2;
      continue;
    }
    if (marker == kEndOfImage) return kept;
    if (marker == kStartOfScan) return kept.append(jpeg.substr(at));
    const std::size_t length = Byte(jpeg, at + 2) << 8 | Byte(jpeg, at + 3);
    if (length < 2 || at + 2 + length > jpeg.size()) return kept;
    const std::string_view segment = jpeg.substr(at, 2 + length);
    if (IsNeeded(marker, segment.substr(kMarkerAndLength))) kept += segment;
    at += segment.size();
  }
  return kept;
}

}  // namespace glint
