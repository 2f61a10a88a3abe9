#include "fitting/refine/log_picture.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "base/reflectance/log_radiance.h"
#include "base/resampling/resampling.h"
#include "fitting/refine/point_spread.h"

namespace glint {
namespace {

// `planes`: filtered, 0 where nothing is usable; `seen`: how much of each was usable.
void OverUsable(const std::vector<float>& usable, const std::vector<float>& seen,
                std::vector<float>* planes) {
  for (size_t i = 0; i < planes->size(); ++i) {
    const size_t t = i % usable.size();
    (*planes)[i] = usable[t] > 0 ? (*planes)[i] / seen[t] : 0.0f;
  }
}

std::vector<Taps> TriangleTaps(int count) {
  std::vector<Taps> all(static_cast<size_t>(count));
  for (int i = 0; i < count; ++i) {
    Taps& taps = all[static_cast<size_t>(i)];
    taps.first = std::max(0, i - kDetailReach);
    float sum = 0;
    for (int k = taps.first; k <= std::min(count - 1, i + kDetailReach); ++k) {
      taps.weights.push_back(static_cast<float>(kDetailReach + 1 - std::abs(k - i)));
      sum += taps.weights.back();
    }
    for (float& weight : taps.weights) weight /= sum;
  }
  return all;
}

}  // namespace

LogPicture::LogPicture(const Photograph& photograph, int width_texel, int height_texel)
    : width(width_texel),
      height(height_texel),
      rgb(photograph.rgb.size(), 0.0f),
      usable(photograph.mask.size(), 0.0f) {
  const size_t texels = usable.size();
  for (size_t t = 0; t < texels; ++t) {
    if (!(photograph.mask[t] >= 0.5f)) continue;
    usable[t] = 1;
    for (size_t c = 0; c < 3; ++c) {
      const float radiance = std::max(photograph.rgb[c * texels + t], 0.0f);
      rgb[c * texels + t] = std::log(radiance + static_cast<float>(kLogOffset));
    }
  }
}

std::vector<float> LogPicture::Blurred(double variance) const {
  const PointSpread spread(variance);
  if (spread.none()) return rgb;
  std::vector<float> blurred = spread.Blurred(rgb, width, height);
  OverUsable(usable, spread.Blurred(usable, width, height), &blurred);
  return blurred;
}

std::vector<float> LogPicture::DetailOf(std::vector<float> plane) const {
  const std::vector<Taps> across = TriangleTaps(width), down = TriangleTaps(height);
  std::vector<float> coarse = ResamplePlanes(plane, width, height, across, down);
  OverUsable(usable, ResamplePlanes(usable, width, height, across, down), &coarse);
  for (size_t t = 0; t < plane.size(); ++t) {
    plane[t] = usable[t] > 0 ? plane[t] - coarse[t] : 0.0f;
  }
  return plane;
}

std::vector<float> Luminance(const std::vector<float>& planes) {
  const size_t texels = planes.size() / 3;
  std::vector<float> mean(texels);
  for (size_t t = 0; t < texels; ++t) {
    mean[t] = (planes[t] + planes[texels + t] + planes[2 * texels + t]) / 3;
  }
  return mean;
}

}  // namespace glint
