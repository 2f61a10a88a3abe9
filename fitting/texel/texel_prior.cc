#include "fitting/texel/texel_prior.h"

#include <cmath>

namespace glint {
namespace {

void NormalOf(const TexelValues& texel, double normal[2], double* length) {
  const double x = texel[kSlopeX], y = texel[kSlopeY];
  *length = 1.0 / std::sqrt(1.0 + x * x + y * y);
  normal[0] = x * *length;
  normal[1] = y * *length;
}

}  // namespace

TexelPrior::TexelPrior(const PriorWeights& weights, const TexelValues& start) : start_(start) {
  const StartErrors& errors = weights.errors;
  const double strength = weights.strength;
  weight_[kSlopeX] = weight_[kSlopeY] = strength / errors.normal;
  weight_[kRough] = strength / errors.roughness;
  for (int c = 0; c < 3; ++c) {
    const int d = DiffuseParameter(c), s = SpecularParameter(c);
    weight_[d] = strength / (errors.diffuse + errors.diffuse_relative * start[d]);
    weight_[s] = strength / (errors.specular + errors.specular_relative * start[s]);
  }
  double length;
  NormalOf(start, start_normal_, &length);
}

void TexelPrior::Evaluate(const TexelValues& texel, double residuals[kTexelParameters],
                          double jacobian[kTexelParameters][kTexelParameters]) const {
  double normal[2], length;
  NormalOf(texel, normal, &length);
  for (int i = 0; i < kTexelParameters; ++i) {
    for (int j = 0; j < kTexelParameters; ++j) jacobian[i][j] = 0.0;
    if (i <= kRough) {
      residuals[i] = weight_[i] * (texel[i] - start_[i]);
      jacobian[i][i] = weight_[i];
      continue;
    }
    const int axis = i - kSlopeX;
    residuals[i] = weight_[i] * (normal[axis] - start_normal_[axis]);
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
