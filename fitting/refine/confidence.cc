#include "fitting/refine/confidence.h"

#include <algorithm>
#include <cmath>

#include "fitting/texel/texel_cholesky.h"

namespace glint {
namespace {

// Widest a standard deviation is said to be: a value in [0, 1] of which nothing is known.
constexpr double kWidest = 1.0;

}  // namespace

std::array<float, kConfidencePlanes> TexelConfidence(const TexelGram& gram,
                                                     const TexelValues& texel, double squares,
                                                     double scale, const TexelCovariance& common) {
  const double variance = scale * scale;
  // What nothing is known of keeps the widest deviation: it stands in for a missing prior.
  double unknown[kTexelParameters];
  std::fill_n(unknown, kTexelParameters, variance / (kWidest * kWidest));
  const TexelCholesky factor(gram, unknown);
  double inverse[kTexelParameters][kTexelParameters];
  for (int i = 0; i < kTexelParameters; ++i) {
    double unit[kTexelParameters] = {};
    unit[i] = 1.0;
    factor.Solve(unit, &inverse[i]);
  }
  const auto covariance = [&](int a, int b) {
    return variance * inverse[a][b] +
           common[static_cast<size_t>(a) * kTexelParameters + static_cast<size_t>(b)];
  };

  // n_x, n_y by the slopes.
  const double x = texel[kSlopeX], y = texel[kSlopeY];
  const double length = 1.0 / std::sqrt(1.0 + x * x + y * y);
  const double nx = x * length, ny = y * length;
  const double by_x[2] = {length * (1.0 - nx * nx), -length * nx * ny};
  const double by_y[2] = {by_x[1], length * (1.0 - ny * ny)};
  const double xx = covariance(kSlopeX, kSlopeX), xy = covariance(kSlopeX, kSlopeY),
               yy = covariance(kSlopeY, kSlopeY);
  const auto normal_variance = [&](int axis) {
    return by_x[axis] * by_x[axis] * xx + 2.0 * by_x[axis] * by_y[axis] * xy +
           by_y[axis] * by_y[axis] * yy;
  };

  // A variance that rounding made negative, or no number, is one of which nothing is known.
  const auto deviation = [](double v) {
    return static_cast<float>(v > 0 ? std::min(std::sqrt(v), kWidest) : kWidest);
  };
  std::array<float, kConfidencePlanes> planes;
  planes[kSigmaNormalX] = deviation(normal_variance(0));
  planes[kSigmaNormalY] = deviation(normal_variance(1));
  planes[kSigmaRoughness] = deviation(covariance(kRough, kRough));
  for (int c = 0; c < 3; ++c) {
    const int d = DiffuseParameter(c), s = SpecularParameter(c);
    planes[kSigmaDiffuseR + c] = deviation(covariance(d, d));
    planes[kSigmaSpecularR + c] = deviation(covariance(s, s));
  }
  planes[kTexelCost] = static_cast<float>(0.5 * squares);
  return planes;
}

}  // namespace glint
