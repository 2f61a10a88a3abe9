// Pictures as stored to pictures as seen.
#pragma once

#include <utility>
#include <vector>

#include "base/photos/stored_image.h"

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

// Interleaved samples; of fewer than three channels the first is taken for all, of more the first
// three.
template <class T>
StoredImage UprightImage(std::vector<T> samples, const StoredSize& stored, int orientation) {
  if (orientation <= 1 && stored.channels == 3) {
    return {stored.width, stored.height, std::move(samples)};
  }
  const bool turned = TurnExchangesAxes(orientation);
  const int width = turned ? stored.height : stored.width;
  const int height = turned ? stored.width : stored.height;
  const bool grey = stored.channels < 3;
  std::vector<T> upright;
  upright.reserve(3 * static_cast<size_t>(width) * static_cast<size_t>(height));
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const auto [sx, sy] = StoredPixel(orientation, x, y, stored);
      const T* pixel =
          samples.data() + (static_cast<size_t>(sy) * stored.width + sx) * stored.channels;
      for (int c = 0; c < 3; ++c) upright.push_back(pixel[grey ? 0 : c]);
    }
  }
  return {width, height, std::move(upright)};
}

}  // namespace glint
