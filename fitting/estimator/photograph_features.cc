#include "fitting/estimator/photograph_features.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "base/reflectance/brdf.h"

namespace glint {
namespace {

using namespace features;

struct Ring {
  double sum[3] = {0, 0, 0}, square = 0, clipped = 0, count = 0;
};

size_t RingOf(double angle) {
  const double degrees = angle * 180.0 / std::numbers::pi;
  const auto end = std::lower_bound(kBinEndDegrees.begin(), kBinEndDegrees.end(), degrees);
  return static_cast<size_t>(
      std::min<std::ptrdiff_t>(end - kBinEndDegrees.begin(), kProfileBins - 1));
}

std::vector<float> Profile(const std::array<Ring, kProfileBins>& rings) {
  std::vector<float> profile;
  for (const Ring& ring : rings) {
    const double n = std::max(1.0, ring.count);
    for (const double sum : ring.sum) profile.push_back(static_cast<float>(sum / n));
    const double mean = ring.sum[1] / n;
    profile.push_back(static_cast<float>(std::sqrt(std::max(0.0, ring.square / n - mean * mean))));
    profile.push_back(static_cast<float>(ring.clipped / n));
    profile.push_back(ring.count > 0 ? 1.0f : 0.0f);
  }
  return profile;
}

}  // namespace

PhotographFeatures FeaturesOf(const Photograph& photograph, const SamplePlane& plane,
                              const ReflectanceConvention& convention) {
  const size_t texels = photograph.mask.size();
  PhotographFeatures features{
      plane.width, plane.height, std::vector<float>(kFeaturePlanes * texels), {}};
  std::array<Ring, kProfileBins> rings{};
  const auto put = [&](int p, size_t i, double value) {
    features.planes[p * texels + i] = static_cast<float>(value);
  };
  for (size_t i = 0; i < texels; ++i) {
    const int row = static_cast<int>(i / plane.width), column = static_cast<int>(i % plane.width);
    const TexelGeometry<double> g = TexelGeometryInView(photograph.view, convention.falloff,
                                                        plane.x_mm(column), plane.y_mm(row));
    const double cosine = std::max(kLeastCosine, g.light[2]);
    const double angle = std::acos(std::clamp(g.half[2], -1.0, 1.0));
    const double mean_e = (g.irradiance[0] + g.irradiance[1] + g.irradiance[2]) / 3;
    put(5, i, g.light[0]);
    put(6, i, g.light[1]);
    put(7, i, g.camera[0]);
    put(8, i, g.camera[1]);
    put(9, i, angle);
    put(10, i,
        std::clamp(std::log(std::max(kLeastIrradiance, mean_e * cosine / std::numbers::pi)),
                   -kLogIrradianceRange, kLogIrradianceRange));
    // To the estimator masked texels of a highlight are part of it, and not unknown: training shows
    // it no holes.
    const bool clipped = ReachesLimit(photograph, i);
    if (photograph.mask[i] < 0.5f && !clipped) continue;
    Ring& ring = rings[RingOf(angle)];
    for (int c = 0; c < 3; ++c) {
      const double radiance = std::max(0.0f, photograph.rgb[c * texels + i]);
      const double albedo =
          std::min(kBrightest, std::numbers::pi * radiance /
                                   std::max(kLeastIrradiance, g.irradiance[c] * cosine));
      put(c, i, std::sqrt(albedo));
      const double log_albedo = std::log(albedo + kOffset);
      ring.sum[c] += log_albedo;
      if (c == 1) ring.square += log_albedo * log_albedo;
    }
    put(3, i, clipped ? 1 : 0);
    put(4, i, 1);
    ring.clipped += clipped;
    ring.count += 1;
  }
  features.profile = Profile(rings);
  return features;
}

}  // namespace glint
