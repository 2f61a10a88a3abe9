#include "fitting/refine/relative_blur.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <numeric>
#include <opencv2/core.hpp>

#include "base/model/photographs.h"
#include "base/parallel/parallel.h"
#include "base/statistics/median.h"
#include "fitting/refine/log_picture.h"

namespace glint {
namespace {

constexpr int kTile = 256, kLeastTile = 64;  // texels
constexpr int kRings = 12;
constexpr double kLeastFrequency = 0.06, kMostFrequency = 0.42;  // cycles per texel

using Powers = std::array<double, kRings>;

double MiddleOf(int ring) {
  return kLeastFrequency + (ring + 0.5) * (kMostFrequency - kLeastFrequency) / kRings;
}

// Of detail under a Hann window, mean by ring.
void AddPowers(const std::vector<float>& detail, int stride, int left, int top, int side,
               Powers* powers) {
  cv::Mat1f tile(side, side);
  const auto hann = [&](int i) {
    return 0.5f - 0.5f * static_cast<float>(std::cos(2 * std::numbers::pi * (i + 0.5) / side));
  };
  for (int row = 0; row < side; ++row) {
    for (int column = 0; column < side; ++column) {
      const auto at = static_cast<size_t>(top + row) * static_cast<size_t>(stride) +
                      static_cast<size_t>(left + column);
      tile(row, column) = detail[at] * hann(row) * hann(column);
    }
  }
  cv::Mat2f spectrum;
  cv::dft(tile, spectrum, cv::DFT_COMPLEX_OUTPUT);
  Powers sums{}, counts{};
  for (int row = 0; row < side; ++row) {
    const double down = std::min(row, side - row) / static_cast<double>(side);
    for (int column = 0; column < side; ++column) {
      const double across = std::min(column, side - column) / static_cast<double>(side);
      const double place = (std::hypot(down, across) - kLeastFrequency) /
                           (kMostFrequency - kLeastFrequency) * kRings;
      if (place < 0 || place >= kRings) continue;
      const cv::Vec2f value = spectrum(row, column);
      sums[static_cast<size_t>(place)] += static_cast<double>(value.dot(value));
      counts[static_cast<size_t>(place)] += 1;
    }
  }
  for (size_t ring = 0; ring < kRings; ++ring) (*powers)[ring] += sums[ring] / counts[ring];
}

Powers PowersOf(const Photograph& photograph, int width, int height, int side) {
  const LogPicture picture(photograph, width, height);
  const std::vector<float> detail = picture.DetailOf(Luminance(picture.rgb));
  Powers powers{};
  const int across = std::max(1, 2 * width / side - 1), down = std::max(1, 2 * height / side - 1);
  for (int row = 0; row < down; ++row) {
    for (int column = 0; column < across; ++column) {
      AddPowers(detail, width, column * side / 2, row * side / 2, side, &powers);
    }
  }
  return powers;
}

// The slope of `y` over f², by least squares.
double SlopeOverSquare(const Powers& y) {
  double mean_x = 0, mean_y = 0, xx = 0, xy = 0;
  for (int ring = 0; ring < kRings; ++ring) {
    mean_x += MiddleOf(ring) * MiddleOf(ring) / kRings;
    mean_y += y[static_cast<size_t>(ring)] / kRings;
  }
  for (int ring = 0; ring < kRings; ++ring) {
    const double x = MiddleOf(ring) * MiddleOf(ring) - mean_x;
    xx += x * x;
    xy += x * (y[static_cast<size_t>(ring)] - mean_y);
  }
  return xy / xx;
}

}  // namespace

std::vector<double> RelativeBlurs(const PhotographSet& set, int threads) {
  const size_t count = set.photographs.size();
  std::vector<double> blurs(count, 0.0);
  const int width = set.plane.width, height = set.plane.height;
  const int side = std::min({kTile, width, height}) / 2 * 2;
  if (count < 3 || side < kLeastTile) return blurs;
  std::vector<Powers> powers(count);
  ForEachPiece(static_cast<int>(count), threads, [&](int piece) {
    const auto v = static_cast<size_t>(piece);
    powers[v] = PowersOf(set.photographs[v], width, height, side);
  });
  constexpr double kNone = 1e-12;
  Powers median{};
  for (size_t ring = 0; ring < kRings; ++ring) {
    std::vector<double> logs;
    logs.reserve(count);
    for (Powers& of : powers) logs.push_back(of[ring] = std::log(of[ring] + kNone));
    median[ring] = Median(logs);
  }
  for (size_t v = 0; v < count; ++v) {
    Powers beside = powers[v];
    for (size_t ring = 0; ring < kRings; ++ring) beside[ring] -= median[ring];
    blurs[v] = -SlopeOverSquare(beside) / (4 * std::numbers::pi * std::numbers::pi);
  }
  std::vector<double> sorted = blurs;
  std::sort(sorted.begin(), sorted.end());
  const size_t sharper = (count + 1) / 2;
  const double usual =
      std::accumulate(sorted.begin(), sorted.begin() + static_cast<std::ptrdiff_t>(sharper), 0.0) /
      static_cast<double>(sharper);
  for (double& blur : blurs) {
    blur = blur - usual > constants::kLeastRelativeBlur ? blur - usual : 0.0;
  }
  return blurs;
}

}  // namespace glint
