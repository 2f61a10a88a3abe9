#include "fitting/refine/point_spread.h"

#include <algorithm>
#include <cmath>

#include "base/model/photographs.h"
#include "base/model/solver.h"
#include "base/reflectance/log_radiance.h"
#include "base/resampling/resampling.h"
#include "fitting/texel/texel_batch.h"

namespace glint {
namespace {

// As few convolutions of three taps as have the variance together: the variance is exact, and the
// response falls like the Gaussian's.
std::vector<float> GaussianTaps(double variance) {
  const int times = static_cast<int>(std::ceil(variance / constants::kThreeTapVariance));
  const double w = variance / times / 2;
  std::vector<double> taps = {1};
  for (int i = 0; i < times; ++i) {
    std::vector<double> wider(taps.size() + 2, 0.0);
    for (size_t t = 0; t < taps.size(); ++t) {
      wider[t] += w * taps[t];
      wider[t + 1] += (1 - 2 * w) * taps[t];
      wider[t + 2] += w * taps[t];
    }
    taps = std::move(wider);
  }
  return {taps.begin(), taps.end()};
}

// For ResamplePlanes(), of a row or column of `count` values.
std::vector<Taps> TapsOf(const std::vector<float>& gaussian, int count) {
  const int reach = static_cast<int>(gaussian.size() / 2);
  std::vector<Taps> all(static_cast<size_t>(count));
  for (int i = 0; i < count; ++i) {
    const int first = std::max(0, i - reach), last = std::min(count - 1, i + reach);
    Taps& taps = all[static_cast<size_t>(i)];
    taps.first = first;
    const int inputs = last - first + 1;
    taps.weights.assign(static_cast<size_t>(inputs), 0.0f);
    int from = i - reach;
    for (const float weight : gaussian) {
      taps.weights[static_cast<size_t>(std::clamp(from++, first, last) - first)] += weight;
    }
  }
  return all;
}

}  // namespace

PointSpread::PointSpread(double pixels_per_texel, double spread_px) {
  if (!(pixels_per_texel > 0) || !(spread_px > 0)) return;
  const double spread = spread_px / pixels_per_texel;
  *this = PointSpread(spread * spread - constants::kTexelVariance);
}

PointSpread::PointSpread(double variance)
    : variance_(std::clamp(variance, 0.0, constants::kMostBlurVariance)) {
  if (variance_ > 0) taps_ = GaussianTaps(variance_);
}

std::vector<float> PointSpread::Blurred(std::span<const float> planes, int width,
                                        int height) const {
  if (none()) return {planes.begin(), planes.end()};
  return ResamplePlanes(planes, width, height, TapsOf(taps_, width), TapsOf(taps_, height));
}

std::vector<float> Deblurred(const PointSpread& spread, std::span<const float> photograph,
                             std::span<const float> mask, bool ldr, std::vector<float> rendering,
                             int width, int height) {
  constexpr auto kOffset = static_cast<float>(kLogOffset);
  const float most = ldr ? 1.0f : INFINITY;
  for (float& r : rendering) r = std::clamp(r, 0.0f, most);
  std::vector<float> residuals = spread.Blurred(rendering, width, height);
  const auto clips = [&](double radiance) {
    return ldr && radiance >= constants::kClippedRadiance;
  };
  for (size_t i = 0; i < residuals.size(); ++i) {
    const float y = std::max(photograph[i], 0.0f);
    if (!(mask[i % mask.size()] >= 0.5f)) {
      residuals[i] = 0;
      continue;
    }
    residuals[i] = std::log((y + kOffset) / (residuals[i] + kOffset));
    // It may be brighter than it shows.
    if (clips(y)) residuals[i] = std::max(residuals[i], 0.0f);
  }
  std::vector<float> missing = spread.Blurred(residuals, width, height);
  for (int step = 1; step < constants::kDeblurSteps; ++step) {
    const std::vector<float> explained = spread.Blurred(missing, width, height);
    std::vector<float> left(residuals.size());
    for (size_t i = 0; i < left.size(); ++i) {
      left[i] = mask[i % mask.size()] >= 0.5f ? residuals[i] - explained[i] : 0.0f;
    }
    left = spread.Blurred(left, width, height);
    for (size_t i = 0; i < missing.size(); ++i) missing[i] += left[i];
  }
  for (size_t i = 0; i < residuals.size(); ++i) {
    const float sharp = (rendering[i] + kOffset) * std::exp(missing[i]) - kOffset;
    rendering[i] = clips(photograph[i]) ? photograph[i] : std::max(sharp, 0.0f);
  }
  return rendering;
}

}  // namespace glint
