#include "fitting/texel/texel_prior.h"

#include <algorithm>
#include <cmath>

#include "fitting/texel/texel_parameters.h"

namespace glint {
namespace {

void NormalOf(const TexelValues& texel, double normal[2], double* length) {
  const double x = texel[kSlopeX], y = texel[kSlopeY];
  *length = 1.0 / std::sqrt(1.0 + x * x + y * y);
  normal[0] = x * *length;
  normal[1] = y * *length;
}

}  // namespace

TexelGaussian::TexelGaussian(const TexelValues& initial, const InitialisationErrors& errors) {
  for (int i = 0; i <= kRough; ++i) {
    const bool specular = i % 2 == 1;
    const double error = i == kRough ? errors.roughness
                         : specular  ? errors.specular + errors.specular_relative * initial[i]
                                     : errors.diffuse + errors.diffuse_relative * initial[i];
    mean_[i] = initial[i];
    precision_[i] = 1 / (error * error);
  }
  NormalOfSlopes(initial[kSlopeX], initial[kSlopeY], &mean_[kSlopeX]);
  precision_[kSlopeX] = precision_[kSlopeY] = 1 / (errors.normal * errors.normal);
}

TexelGaussian::TexelGaussian(const TexelValues& initial,
                             const std::array<double, kTexelParameters>& sd)
    : mean_(initial) {
  NormalOfSlopes(initial[kSlopeX], initial[kSlopeY], &mean_[kSlopeX]);
  for (size_t i = 0; i < sd.size(); ++i) precision_[i] = 1 / (sd[i] * sd[i]);
}

void TexelGaussian::Multiply(int parameter, double mean, double precision) {
  const double sum = precision_[parameter] + precision;
  if (!(sum > 0)) return;
  mean_[parameter] += precision / sum * (mean - mean_[parameter]);
  precision_[parameter] = sum;
}

void NormalOfSlopes(double slope_x, double slope_y, double normal[2]) {
  const double length = 1.0 / std::sqrt(1.0 + slope_x * slope_x + slope_y * slope_y);
  normal[0] = slope_x * length;
  normal[1] = slope_y * length;
}

TexelPrior::TexelPrior(const TexelGaussian& gaussian, double scale) {
  for (int i = 0; i < kTexelParameters; ++i) {
    mean_[i] = gaussian.mean(i);
    weight_[i] = scale * std::sqrt(gaussian.precision(i));
  }
  const double x = mean_normal_[0] = gaussian.mean(kSlopeX);
  const double y = mean_normal_[1] = gaussian.mean(kSlopeY);
  const double z = std::sqrt(std::max(1.0 - x * x - y * y, 1.0 / (1.0 + kMostSlope * kMostSlope)));
  mean_[kSlopeX] = x / z;
  mean_[kSlopeY] = y / z;
}

void TexelPrior::Evaluate(const TexelValues& texel, double residuals[kTexelParameters],
                          double jacobian[kTexelParameters][kTexelParameters]) const {
  double normal[2], length;
  NormalOf(texel, normal, &length);
  for (int i = 0; i < kTexelParameters; ++i) {
    for (int j = 0; j < kTexelParameters; ++j) jacobian[i][j] = 0.0;
    if (i <= kRough) {
      residuals[i] = weight_[i] * (texel[i] - mean_[i]);
      jacobian[i][i] = weight_[i];
      continue;
    }
    const int axis = i - kSlopeX;
    residuals[i] = weight_[i] * (normal[axis] - mean_normal_[axis]);
    for (int j = kSlopeX; j <= kSlopeY; ++j) {
      jacobian[i][j] =
          weight_[i] * length * ((i == j ? 1.0 : 0.0) - normal[axis] * normal[j - kSlopeX]);
    }
  }
}

void TexelPrior::AddTo(const TexelValues& texel, TexelGram* gram) const {
  TexelGram& g = *gram;
  constexpr int kSquares = kTexelParameters;
  double f[kTexelParameters], j[kTexelParameters][kTexelParameters];
  Evaluate(texel, f, j);
  for (int i = 0; i <= kRough; ++i) {
    g[i][i] += j[i][i] * j[i][i];
    g[i][kSquares] += j[i][i] * f[i];
    g[kSquares][kSquares] += f[i] * f[i];
  }
  for (int i = kSlopeX; i <= kSlopeY; ++i) {
    g[kSlopeX][kSlopeX] += j[i][kSlopeX] * j[i][kSlopeX];
    g[kSlopeX][kSlopeY] += j[i][kSlopeX] * j[i][kSlopeY];
    g[kSlopeY][kSlopeY] += j[i][kSlopeY] * j[i][kSlopeY];
    g[kSlopeX][kSquares] += j[i][kSlopeX] * f[i];
    g[kSlopeY][kSquares] += j[i][kSlopeY] * f[i];
    g[kSquares][kSquares] += f[i] * f[i];
  }
}

double TexelPrior::SquaredNorm(const TexelValues& texel) const {
  double f[kTexelParameters], j[kTexelParameters][kTexelParameters];
  Evaluate(texel, f, j);
  double sum = 0.0;
  for (const double residual : f) sum += residual * residual;
  return sum;
}

}  // namespace glint
