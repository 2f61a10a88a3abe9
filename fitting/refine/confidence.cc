#include "fitting/refine/confidence.h"

#include <Eigen/Core>
#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

namespace glint {
namespace {

// Widest a standard deviation is said to be: a value in [0, 1] of which nothing is known.
constexpr double kWidest = 1.0;

}  // namespace

std::array<float, kConfidencePlanes> TexelConfidence(const TexelGram& gram,
                                                     const TexelValues& texel, int residuals,
                                                     double residual_sigma) {
  using Matrix = Eigen::Matrix<double, kTexelParameters, kTexelParameters>;
  Matrix information;
  for (int i = 0; i < kTexelParameters; ++i) {
    for (int j = 0; j < kTexelParameters; ++j) information(i, j) = gram[i][j];
  }
  const double squares = gram[kTexelParameters][kTexelParameters];
  const double variance =
      (kCommonWeight * residual_sigma * residual_sigma + squares) / (kCommonWeight + residuals);
  // What nothing is known of keeps the widest deviation: it stands in for a missing prior.
  information.diagonal().array() += variance / (kWidest * kWidest);
  const Matrix covariance = variance * information.ldlt().solve(Matrix::Identity());

  // n_x, n_y by the slopes.
  const double x = texel[kSlopeX], y = texel[kSlopeY];
  const double length = 1.0 / std::sqrt(1.0 + x * x + y * y);
  const double nx = x * length, ny = y * length;
  Eigen::Matrix2d by_slopes;
  by_slopes << 1.0 - nx * nx, -nx * ny, -nx * ny, 1.0 - ny * ny;
  by_slopes *= length;
  const Eigen::Matrix2d normal =
      by_slopes * covariance.block<2, 2>(kSlopeX, kSlopeX) * by_slopes.transpose();

  const auto deviation = [](double v) {
    return static_cast<float>(std::min(std::sqrt(std::max(v, 0.0)), kWidest));
  };
  std::array<float, kConfidencePlanes> planes;
  planes[kSigmaNormalX] = deviation(normal(0, 0));
  planes[kSigmaNormalY] = deviation(normal(1, 1));
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
