#include "base/photos/stored_image.h"

#include <algorithm>

namespace glint {
namespace {

template <class T>
StoredImage Interleaved(const Image& image) {
  std::vector<T> samples(3 * image.pixels());
  for (int c = 0; c < 3; ++c) {
    const auto plane = image.channel(c);
    for (size_t i = 0; i < plane.size(); ++i) {
      T& sample = samples[3 * i + static_cast<size_t>(c)];
      if constexpr (std::is_floating_point_v<T>) {
        sample = plane[i];
      } else {
        constexpr float kMax = std::numeric_limits<T>::max();
        sample = static_cast<T>(std::clamp(plane[i], 0.0f, 1.0f) * kMax + 0.5f);
      }
    }
  }
  return {image.width, image.height, std::move(samples)};
}

}  // namespace

Image StoredImage::Planes() const {
  Image image(width, height, kRgbChannels);
  Visit([&](const auto& samples) {
    for (int c = 0; c < 3; ++c) {
      const auto plane = image.channel(c);
      for (size_t i = 0; i < plane.size(); ++i) {
        plane[i] = ValueOf(samples[3 * i + static_cast<size_t>(c)]);
      }
    }
  });
  return image;
}

StoredImage Stored(const Image& image, int bits) {
  if (bits == 8) return Interleaved<std::uint8_t>(image);
  if (bits == 16) return Interleaved<std::uint16_t>(image);
  return Interleaved<float>(image);
}

}  // namespace glint
