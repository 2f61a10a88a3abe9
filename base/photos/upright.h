// Pictures as stored to pictures as seen.
#pragma once

#include <utility>
#include <vector>

#include "base/images/image.h"

namespace glint {

struct StoredSize {
  int width = 0, height = 0, channels = 0;
};

// EXIF orientations 5–8 exchange width and height.
inline bool TurnExchangesAxes(int orientation) { return orientation >= 5; }

// Column and row in the stored picture of the upright pixel (x, y).
inline std::pair<int, int> StoredPixel(int orientation, int x, int y, const StoredSize& size) {
  const int right = size.width - 1, bottom = size.height - 1;
  switch (orientation) {
    case 2:
      return {right - x, y};
    case 3:
      return {right - x, bottom - y};
    case 4:
      return {x, bottom - y};
    case 5:
      return {y, x};
    case 6:
      return {y, bottom - x};
    case 7:
      return {right - y, bottom - x};
    case 8:
      return {right - y, x};
    default:
      return {x, y};
  }
}

// Interleaved samples, times `scale`, to planes R, G, B; of fewer than three channels the first is
// taken for all.
template <class T>
Image UprightImage(const std::vector<T>& samples, const StoredSize& stored, int orientation,
                   double scale) {
  const bool turned = TurnExchangesAxes(orientation);
  Image image(turned ? stored.height : stored.width, turned ? stored.width : stored.height,
              {"R", "G", "B"});
  const bool grey = stored.channels < 3;
  const float factor = static_cast<float>(scale);
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      const auto [sx, sy] = StoredPixel(orientation, x, y, stored);
      const T* pixel =
          samples.data() + (static_cast<size_t>(sy) * stored.width + sx) * stored.channels;
      const size_t at = static_cast<size_t>(y) * image.width + x;
      for (int c = 0; c < 3; ++c) {
        image.samples[c * image.pixels() + at] = static_cast<float>(pixel[grey ? 0 : c]) * factor;
      }
    }
  }
  return image;
}

}  // namespace glint
