#include "calib/corners/gray_image.h"

#include <algorithm>
#include <cmath>

namespace glint {
namespace {

float Luma(float red, float green, float blue) {
  return 0.299f * red + 0.587f * green + 0.114f * blue;
}

// As std::lround(255·value) of a value in [0, 1]: a float and a half fit into a double.
unsigned char CodeOf(float value) {
  return static_cast<unsigned char>(
      static_cast<int>(static_cast<double>(255.0f * std::clamp(value, 0.0f, 1.0f)) + 0.5));
}

// The value below which 99 % of a regular subset of the pixels lie.
float Percentile99(const std::vector<float>& luma) {
  std::vector<float> subset;
  const size_t step = std::max<size_t>(1, luma.size() / 100000);
  for (size_t i = 0; i < luma.size(); i += step) subset.push_back(luma[i]);
  const auto nth = subset.begin() + static_cast<std::ptrdiff_t>(subset.size() * 99 / 100);
  std::nth_element(subset.begin(), nth, subset.end());
  return *nth;
}

// Linear photographs as edges in dark parts ask for.
void Brighten(std::vector<float>* luma) {
  const float white = std::max(Percentile99(*luma), 1e-12f);
  for (float& value : *luma) {
    value = std::pow(std::clamp(value / white, 0.0f, 1.0f), 1.0f / 2.2f);
  }
}

template <class T>
GrayImage GrayFrom(const StoredImage& image, const std::vector<T>& samples, bool linear) {
  GrayImage gray{image.width, image.height, std::vector<unsigned char>(image.pixels())};
  const auto luma_at = [&](size_t i) {
    return Luma(StoredImage::ValueOf(samples[3 * i]), StoredImage::ValueOf(samples[3 * i + 1]),
                StoredImage::ValueOf(samples[3 * i + 2]));
  };
  if (!linear) {
    for (size_t i = 0; i < gray.samples.size(); ++i) gray.samples[i] = CodeOf(luma_at(i));
    return gray;
  }
  std::vector<float> luma(image.pixels());
  for (size_t i = 0; i < luma.size(); ++i) luma[i] = luma_at(i);
  Brighten(&luma);
  for (size_t i = 0; i < luma.size(); ++i) gray.samples[i] = CodeOf(luma[i]);
  return gray;
}

}  // namespace

GrayImage GrayFromPhoto(const Photo& photo) {
  if (photo.image.pixels() == 0) return {};
  const bool linear = photo.is_float() || photo.format == "raw";
  return photo.image.Visit(
      [&](const auto& samples) { return GrayFrom(photo.image, samples, linear); });
}

GrayImage Reduced(const GrayImage& image, int longest_px, int* factor) {
  const int f = (std::max(image.width, image.height) + longest_px - 1) / longest_px;
  *factor = std::max(1, f);
  if (f <= 1) return image;
  GrayImage small{image.width / f, image.height / f, {}};
  small.samples.resize(static_cast<size_t>(small.width) * small.height);
  for (int row = 0; row < small.height; ++row) {
    for (int column = 0; column < small.width; ++column) {
      int sum = f * f / 2;
      for (int y = 0; y < f; ++y) {
        for (int x = 0; x < f; ++x) sum += image.at(column * f + x, row * f + y);
      }
      small.samples[static_cast<size_t>(row) * small.width + column] =
          static_cast<unsigned char>(sum / (f * f));
    }
  }
  return small;
}

}  // namespace glint
