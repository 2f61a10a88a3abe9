#include "fitting/refine/texel_prior.h"

#include <cmath>

namespace glint {

TexelPrior::TexelPrior(const PriorWeights& weights, const TexelValues& start) : start_(start) {
  weight_[kSlopeX] = weight_[kSlopeY] = weights.normal;
  weight_[kRough] = weights.roughness;
  for (int c = 0; c < 3; ++c) {
    weight_[DiffuseParameter(c)] = weights.diffuse;
    weight_[SpecularParameter(c)] = weights.specular;
  }
  const double x = start[kSlopeX], y = start[kSlopeY];
  const double length = 1.0 / std::sqrt(1.0 + x * x + y * y);
  start_normal_[0] = x * length;
  start_normal_[1] = y * length;
}

void TexelPrior::Evaluate(const TexelValues& texel, double residuals[kTexelParameters],
                          double jacobian[kTexelParameters][kTexelParameters]) const {
  const double px = texel[kSlopeX], py = texel[kSlopeY];
  const double length = 1.0 / std::sqrt(1.0 + px * px + py * py);
  const double normal[2] = {px * length, py * length};
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
  const double px = texel[kSlopeX], py = texel[kSlopeY];
  const double length = 1.0 / std::sqrt(1.0 + px * px + py * py);
  const double dx = weight_[kSlopeX] * (px * length - start_normal_[0]);
  const double dy = weight_[kSlopeY] * (py * length - start_normal_[1]);
  double sum = dx * dx + dy * dy;
  for (int i = 0; i <= kRough; ++i) {
    const double d = weight_[i] * (texel[i] - start_[i]);
    sum += d * d;
  }
  return sum;
}

}  // namespace glint
