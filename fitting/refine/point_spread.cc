#include "fitting/refine/point_spread.h"

#include <algorithm>
#include <cmath>

#include "fitting/reflectance/log_radiance.h"
#include "fitting/texel/texel_observations.h"

namespace glint {
namespace {

// Of a Gaussian whose response at half a cycle per texel is that of a texel's area, sinc(1/2).
constexpr double kTexelVariance = 0.0915;
// Response at half a cycle per texel above .8: what is mixed is left to the residuals.
constexpr double kLeastVariance = 0.045;
// What two texels a pixel have at .67 pixels. Beyond, photographs say nothing of single texels, and
// less spread asks less of them.
constexpr double kMostVariance = 2;
// Of [w, 1 − 2w, w] with w = ¼, at which the response falls to 0 at half a cycle.
constexpr double kThreeTapVariance = 0.5;

// As few convolutions of three taps as have the variance together: the variance is exact, and the
// response falls like the Gaussian's.
std::vector<float> GaussianTaps(double variance) {
  const int times = static_cast<int>(std::ceil(variance / kThreeTapVariance));
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

// out[i] = Σ taps[t]·in[i + t].
void Correlate(const std::vector<float>& taps, const float* in, int count, float* out) {
  std::fill(out, out + count, 0.0f);
  for (size_t t = 0; t < taps.size(); ++t) {
    const float tap = taps[t];
    for (int i = 0; i < count; ++i) out[i] += tap * in[static_cast<size_t>(i) + t];
  }
}

}  // namespace

PointSpread::PointSpread(double pixels_per_texel, double spread_px) {
  if (!(pixels_per_texel > 0) || !(spread_px > 0)) return;
  const double spread = spread_px / pixels_per_texel;
  variance_ = std::clamp(spread * spread - kTexelVariance, 0.0, kMostVariance);
  if (variance_ < kLeastVariance) variance_ = 0;
  if (variance_ > 0) taps_ = GaussianTaps(variance_);
}

std::vector<float> PointSpread::Spread(std::span<const float> planes, int width, int height) const {
  std::vector<float> spread(planes.begin(), planes.end());
  if (none()) return spread;
  const size_t stride = static_cast<size_t>(width), size = stride * static_cast<size_t>(height);
  const int far = reach();
  std::vector<float> across(size), padded(stride + taps_.size() - 1);
  for (size_t first = 0; first < planes.size(); first += size) {
    for (int row = 0; row < height; ++row) {
      const float* in = &planes[first + static_cast<size_t>(row) * stride];
      std::fill_n(padded.begin(), far, in[0]);
      std::copy_n(in, width, padded.begin() + far);
      std::fill_n(padded.end() - far, far, in[width - 1]);
      Correlate(taps_, padded.data(), width, &across[static_cast<size_t>(row) * stride]);
    }
    for (int row = 0; row < height; ++row) {
      float* out = &spread[first + static_cast<size_t>(row) * stride];
      std::fill_n(out, width, 0.0f);
      int from = row - far;
      for (const float tap : taps_) {
        const float* in = &across[static_cast<size_t>(std::clamp(from++, 0, height - 1)) * stride];
        for (int i = 0; i < width; ++i) out[i] += tap * in[i];
      }
    }
  }
  return spread;
}

std::vector<float> Unmixed(const PointSpread& spread, std::span<const float> photograph,
                           std::span<const float> mask, bool ldr, std::vector<float> rendering,
                           int width, int height) {
  constexpr auto kOffset = static_cast<float>(kLogOffset);
  const float most = ldr ? 1.0f : INFINITY;
  for (float& r : rendering) r = std::clamp(r, 0.0f, most);
  std::vector<float> residuals = spread.Spread(rendering, width, height);
  const auto clips = [&](double radiance) { return ldr && radiance >= kClipped; };
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
  residuals = spread.Spread(residuals, width, height);
  for (size_t i = 0; i < residuals.size(); ++i) {
    const float sharp = (rendering[i] + kOffset) * std::exp(residuals[i]) - kOffset;
    rendering[i] = clips(photograph[i]) ? photograph[i] : std::max(sharp, 0.0f);
  }
  return rendering;
}

}  // namespace glint
