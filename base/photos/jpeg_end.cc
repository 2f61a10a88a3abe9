#include "base/photos/jpeg_end.h"

#include <cstddef>

namespace glint {
namespace {

unsigned Byte(std::string_view bytes, size_t i) { return static_cast<unsigned char>(bytes[i]); }

}  // namespace

bool JpegIsComplete(std::string_view bytes) {
  constexpr unsigned kStartOfImage = 0xD8, kEndOfImage = 0xD9;
  if (bytes.size() < 2 || Byte(bytes, 0) != 0xFF || Byte(bytes, 1) != kStartOfImage) return true;
  // From marker to marker; in between lie segments, whose length is told, and entropy-coded data,
  // in which 0xFF is followed by 0 or a restart marker.
  size_t at = 2;
  while (at + 1 < bytes.size()) {
    const unsigned marker = Byte(bytes, at + 1);
    if (Byte(bytes, at) != 0xFF || marker == 0xFF) {
      ++at;
    } else if (marker == kEndOfImage) {
      return true;
    } else if (marker == 0 || (marker >= 0xD0 && marker <= 0xD7) || marker == 0x01) {
      at += 2;
    } else {
      if (at + 3 >= bytes.size()) return false;
      at += 2 + (Byte(bytes, at + 2) << 8 | Byte(bytes, at + 3));
    }
  }
  return false;
}

}  // namespace glint
