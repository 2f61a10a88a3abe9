#include "calib/corners/gray_image.h"

#include <algorithm>
#include <cmath>

namespace glint {
namespace {

float Luma(const Image& image, size_t i) {
  return 0.299f * image.channel(0)[i] + 0.587f * image.channel(1)[i] + 0.114f * image.channel(2)[i];
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

}  // namespace

GrayImage GrayFromPhoto(const Photo& photo) {
  const Image& image = photo.image;
  GrayImage gray{image.width, image.height, std::vector<unsigned char>(image.pixels())};
  if (image.pixels() == 0) return gray;
  std::vector<float> luma(image.pixels());
  for (size_t i = 0; i < luma.size(); ++i) luma[i] = Luma(image, i);
  if (photo.is_float() || photo.format == "raw") {
    const float white = std::max(Percentile99(luma), 1e-12f);
    for (float& value : luma) {
      value = std::pow(std::clamp(value / white, 0.0f, 1.0f), 1.0f / 2.2f);
    }
  }
  for (size_t i = 0; i < luma.size(); ++i) {
    gray.samples[i] =
        static_cast<unsigned char>(std::lround(255.0f * std::clamp(luma[i], 0.0f, 1.0f)));
  }
  return gray;
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
