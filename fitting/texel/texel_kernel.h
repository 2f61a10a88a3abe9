// Residuals of one texel in all its views with their analytic derivatives: the inner loop of
// refinement, over arrays of views.
//
// With R the rendered and I the photographed radiance of a view and channel,
//   e = min(log(R + 0.01) − log(I + 0.01), ceiling),       residual = √weight · g(e)
//   g(e) = e · √(2 / (1 + √(1 + (e/δ)²))),                 so that g²/2 is Charbonnier's loss
//                                                          δ²(√(1 + (e/δ)²) − 1):
// quadratic within the robust scale δ, linear beyond (Charbonnier et al., "Two deterministic
// half-quadratic regularization algorithms", ICIP 1994). g is smooth, so that a plain least-squares
// solver minimises the robust cost itself and needs no reweighting.
#pragma once

#include <array>
#include <vector>

#include "fitting/texel/texel_observations.h"

namespace glint {

// A texel as the solver sees it. Albedos come first and by channel: a channel's residuals depend on
// that channel's albedos only, so a Cholesky factor in this order keeps the zeros between channels.
enum TexelParameter : int {
  kAlbedos = 0,  // diffuse.R, specular.R, diffuse.G, specular.G, diffuse.B, specular.B
  kRough = 6,
  kSlopeX,  // normal ∝ (slope_x, slope_y, 1)
  kSlopeY,
  kTexelParameters = 9
};
inline constexpr int DiffuseParameter(int channel) { return kAlbedos + 2 * channel; }
inline constexpr int SpecularParameter(int channel) { return kAlbedos + 2 * channel + 1; }

using TexelValues = std::array<double, kTexelParameters>;

// [J f]ᵀ[J f] of residuals f with Jacobian J: the normal equations with the squared norm of f in
// the last corner. Symmetric; only the upper triangle (column ≥ row) is used.
inline constexpr int kGramSize = kTexelParameters + 1;
using TexelGram = std::array<std::array<double, kGramSize>, kGramSize>;

struct KernelOptions {
  DiffuseWeight diffuse_weight = DiffuseWeight::kOne;
  double robust_scale = 0.1;  // δ, in units of the logarithm
};

// Scratch memory of one thread: residuals and the non-zero derivatives of each, padded as the
// observations are.
class KernelRows {
 public:
  // Rows of each channel, in this order; the two albedos are the channel's own.
  enum Row : int { kByDiffuse, kBySpecular, kByRough, kBySlopeX, kBySlopeY, kResidual, kRows };

  explicit KernelRows(int most_views);
  double* row(int channel, int r) {
    return rows_ + static_cast<size_t>(channel * kRows + r) * stride_;
  }
  const double* row(int channel, int r) const {
    return rows_ + static_cast<size_t>(channel * kRows + r) * stride_;
  }
  double* lobe(int l) { return rows_ + static_cast<size_t>(3 * kRows + l) * stride_; }
  const double* lobe(int l) const { return rows_ + static_cast<size_t>(3 * kRows + l) * stride_; }

  static constexpr int kLobes = 7;
  KernelRows(const KernelRows&) = delete;
  KernelRows& operator=(const KernelRows&) = delete;

 private:
  int stride_;
  std::vector<double> storage_;
  double* rows_;
};

// Replaces `values` (> 0, `count` a multiple of kLanes, aligned as the observations are) by their
// logarithms, and writes their inverses.
void TakeLogarithms(int count, double* values, double* inverses);

// Residuals and derivatives of every view and channel into `rows`.
void EvaluateRows(const KernelOptions& options, const TexelObservations& observations,
                  const TexelValues& texel, KernelRows* rows);

// EvaluateRows, then the Gram matrix of all rows.
void EvaluateGram(const KernelOptions& options, const TexelObservations& observations,
                  const TexelValues& texel, KernelRows* rows, TexelGram* gram);

// The inverse of g: |e| for `count` residuals g(e) of weight 1.
void LogDifferences(const double* residuals, int count, double robust_scale, double* differences);

}  // namespace glint
