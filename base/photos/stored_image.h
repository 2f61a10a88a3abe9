// A picture's samples as they are stored.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

#include "base/images/image.h"

namespace glint {

// R, G and B of a pixel beside each other, rows top to bottom: codes of 8 or 16 bits (36 or 72 MB
// for 12 megapixels, where floats would take 144), or floats.
class StoredImage {
 public:
  int width = 0, height = 0;  // also where samples are not held

  StoredImage() = default;
  // 3·width·height samples of uint8_t, uint16_t or float.
  template <class T>
  StoredImage(int width_in, int height_in, std::vector<T> samples)
      : width(width_in), height(height_in), samples_(std::move(samples)) {}

  size_t pixels() const { return static_cast<size_t>(width) * static_cast<size_t>(height); }

  // The stored value of such a sample: a code over the largest there is; a float is its own.
  template <class T>
  static float ValueOf(T sample) {
    if constexpr (std::is_floating_point_v<T>) return sample;
    constexpr float kScale = static_cast<float>(1.0 / std::numeric_limits<T>::max());
    return static_cast<float>(sample) * kScale;
  }

  // f(samples) with the std::vector that holds them: channel c of a pixel is [3·pixel + c].
  template <class F>
  decltype(auto) Visit(F&& f) const {
    return std::visit(std::forward<F>(f), samples_);
  }
  template <class F>
  decltype(auto) Visit(F&& f) {
    return std::visit(std::forward<F>(f), samples_);
  }

  float at(size_t pixel, int channel) const {
    return Visit([&](const auto& samples) {
      return ValueOf(samples[3 * pixel + static_cast<size_t>(channel)]);
    });
  }

  // Stored values in planes R, G, B.
  Image Planes() const;

 private:
  std::variant<std::vector<std::uint8_t>, std::vector<std::uint16_t>, std::vector<float>> samples_;
};

// Planes R, G, B rounded to codes of 8 or 16 bits, or as they are (32).
StoredImage Stored(const Image& image, int bits);

}  // namespace glint
