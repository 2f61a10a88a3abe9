#include "rectify/linearize/light_guess.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace glint {
namespace {

constexpr int kGrid = 64;
constexpr double kMedianAlbedo = 0.3;
constexpr double kBrightAlbedo = 0.95;

// Irradiance on the texel at (x, y) of a light of power 1.
double UnitIrradiance(const View& view, LightFalloff falloff, double x_mm, double y_mm) {
  const double dx = view.light_in_sample_mm[0] - x_mm;
  const double dy = view.light_in_sample_mm[1] - y_mm;
  const double dz = view.light_in_sample_mm[2];
  const double d2 = dx * dx + dy * dy + dz * dz;
  const double cosine = dz / std::sqrt(d2);
  return falloff == LightFalloff::kInverseSquare ? cosine / d2 : cosine;
}

}  // namespace

LightGuess::LightGuess(const SamplePlane& plane, LightFalloff falloff)
    : plane_(plane),
      falloff_(falloff),
      columns_(std::min(kGrid, plane.width)),
      rows_(std::min(kGrid, plane.height)),
      smallest_(static_cast<size_t>(columns_) * rows_, std::numeric_limits<float>::infinity()) {}

void LightGuess::Add(const View& view, const RectifiedImage& image) {
  const size_t texels = static_cast<size_t>(image.width) * image.height;
  for (int j = 0; j < rows_; ++j) {
    const int row = static_cast<int>((2 * static_cast<int64_t>(j) + 1) * image.height / (2 * rows_));
    for (int i = 0; i < columns_; ++i) {
      const int column =
          static_cast<int>((2 * static_cast<int64_t>(i) + 1) * image.width / (2 * columns_));
      const size_t texel = static_cast<size_t>(row) * image.width + column;
      if (image.mask[texel] < 0.5f) continue;
      const double irradiance =
          UnitIrradiance(view, falloff_, plane_.x_mm(column), plane_.y_mm(row)) * view.exposure;
      if (!(irradiance > 0)) continue;
      const double mean =
          (image.rgb[texel] + image.rgb[texels + texel] + image.rgb[2 * texels + texel]) / 3.0;
      float& smallest = smallest_[static_cast<size_t>(j) * columns_ + i];
      smallest = std::min(smallest, static_cast<float>(std::numbers::pi * mean / irradiance));
    }
  }
}

double LightGuess::Power() const {
  std::vector<float> seen;
  for (const float q : smallest_) {
    if (std::isfinite(q)) seen.push_back(q);
  }
  if (seen.empty()) return 0;
  std::sort(seen.begin(), seen.end());
  const double median = seen[seen.size() / 2];
  const double bright = seen[seen.size() * 95 / 100];
  return std::max(median / kMedianAlbedo, bright / kBrightAlbedo);
}

}  // namespace glint
