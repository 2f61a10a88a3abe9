#include "base/programs/capture_size.h"

#include "base/errors/errors.h"
#include "base/photos/photo.h"

namespace glint {

CaptureSize SizeOf(const Capture& capture) {
  CaptureSize size = SizeOfMaps(capture);
  if (capture.imported() || capture.photos.empty()) return size;
  try {
    const auto [width, height] = PhotoSize(capture.folder / capture.photos.front());
    size.photograph_px = static_cast<double>(width) * height;
  } catch (const Error&) {
    // The stage that reads it will say so.
  }
  return size;
}

}  // namespace glint
