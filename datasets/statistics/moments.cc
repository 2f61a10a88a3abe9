#include "datasets/statistics/moments.h"

#include <cmath>
#include <limits>
#include <vector>

namespace glint {
namespace {

constexpr double kFlat = 1e-4;

// Difference from the mean of the four neighbours, inside the border.
std::vector<float> Details(std::span<const float> plane, int width) {
  const int height = static_cast<int>(plane.size()) / width;
  std::vector<float> out;
  out.reserve(plane.size());
  for (int y = 1; y + 1 < height; ++y) {
    for (int x = 1; x + 1 < width; ++x) {
      const float* at = plane.data() + static_cast<size_t>(y) * width + x;
      out.push_back(at[0] - 0.25f * (at[-1] + at[1] + at[-width] + at[width]));
    }
  }
  return out;
}

}  // namespace

Moments MomentsOf(std::span<const float> plane) {
  Moments m;
  const double n = static_cast<double>(plane.size());
  if (plane.empty()) return m;
  for (const float value : plane) m.mean += value / n;
  double second = 0, third = 0, fourth = 0;
  for (const float value : plane) {
    const double d = value - m.mean;
    second += d * d / n;
    third += d * d * d / n;
    fourth += d * d * d * d / n;
  }
  m.spread = std::sqrt(second);
  if (m.spread > 1e-9) {
    m.skewness = third / (second * m.spread);
    m.kurtosis = fourth / (second * second);
  }
  return m;
}

double Correlation(std::span<const float> a, std::span<const float> b) {
  const Moments ma = MomentsOf(a), mb = MomentsOf(b);
  if (ma.spread < kFlat || mb.spread < kFlat) return std::numeric_limits<double>::quiet_NaN();
  double sum = 0;
  for (size_t i = 0; i < a.size(); ++i) sum += (a[i] - ma.mean) * (b[i] - mb.mean);
  return sum / static_cast<double>(a.size()) / (ma.spread * mb.spread);
}

double FineCorrelation(std::span<const float> a, std::span<const float> b, int width) {
  return Correlation(Details(a, width), Details(b, width));
}

double Directionality(std::span<const float> plane, int width) {
  const int height = static_cast<int>(plane.size()) / width;
  double xx = 0, xy = 0, yy = 0;
  for (int y = 1; y + 1 < height; ++y) {
    for (int x = 1; x + 1 < width; ++x) {
      const float* at = plane.data() + static_cast<size_t>(y) * width + x;
      const double gx = at[1] - at[-1], gy = at[width] - at[-width];
      xx += gx * gx;
      xy += gx * gy;
      yy += gy * gy;
    }
  }
  return xx + yy < 1e-12 ? 0 : std::hypot(xx - yy, 2 * xy) / (xx + yy);
}

}  // namespace glint
