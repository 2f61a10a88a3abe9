#include "base/images/jpeg_segments.h"

#include <cstddef>
#include <map>

namespace glint {
namespace {

constexpr unsigned kJfif = 0xE0, kExif = 0xE1, kIcc = 0xE2, kAdobe = 0xEE, kLastApp = 0xEF,
                   kComment = 0xFE;
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

constexpr std::size_t kStartOfImage = 2, kMarkerAndLength = 4;

// Calls visit(marker, segment) with each segment before the picture's data, its marker and length
// included. Returns where that data begins; the file's size where it has none.
template <class Visit>
std::size_t ForEachSegment(std::string_view jpeg, const Visit& visit) {
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
    if (marker == kEndOfImage) break;
    if (marker == kStartOfScan) return at;
    const std::size_t length = Byte(jpeg, at + 2) << 8 | Byte(jpeg, at + 3);
    if (length < 2 || at + 2 + length > jpeg.size()) break;
    visit(marker, jpeg.substr(at, 2 + length));
    at += 2 + length;
  }
  return jpeg.size();
}

}  // namespace

std::string WithPictureSegmentsAlone(std::string_view jpeg) {
  std::string kept(jpeg.substr(0, kStartOfImage));
  const std::size_t data = ForEachSegment(jpeg, [&](unsigned marker, std::string_view segment) {
    if (IsNeeded(marker, segment.substr(kMarkerAndLength))) kept += segment;
  });
  return kept.append(jpeg.substr(data));
}

std::string IccOfJpeg(std::string_view jpeg) {
  using namespace std::string_view_literals;
  constexpr std::string_view kMark = "ICC_PROFILE\0"sv;
  constexpr std::size_t kBeforeBytes = kMark.size() + 2;  // the part's number, and of how many
  std::map<unsigned, std::string_view> parts;
  unsigned count = 0;
  ForEachSegment(jpeg, [&](unsigned marker, std::string_view segment) {
    const std::string_view content = segment.substr(kMarkerAndLength);
    if (marker != kIcc || !content.starts_with(kMark) || content.size() <= kBeforeBytes) return;
    count = Byte(content, kMark.size() + 1);
    parts[Byte(content, kMark.size())] = content.substr(kBeforeBytes);
  });
  if (count == 0 || parts.size() != count || parts.begin()->first != 1) return {};
  std::string icc;
  for (const auto& [number, part] : parts) icc += part;
  return icc;
}

}  // namespace glint
