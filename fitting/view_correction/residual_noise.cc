#include "fitting/view_correction/residual_noise.h"

#include <algorithm>

namespace glint {
namespace {

// Of the solution's nine parameters, five can follow what the channels share (both albedos of all
// channels together, roughness, two slopes), four the rest.
constexpr int kCommonParameters = 5;
constexpr int kOtherParameters = kTexelParameters - kCommonParameters;
constexpr int kLeastViews = kCommonParameters + 2;

}  // namespace

void ResidualNoise::Add(const BatchObservations& observations, const BatchResiduals& residuals,
                        int lane, double variance) {
  const int views = observations.seen(lane);
  if (views < kLeastViews || !(variance > 0)) return;
  double common = 0, all = 0;
  for (int v = 0; v < observations.views(); ++v) {
    if (!observations.sees(v, lane)) continue;
    double sum = 0;
    for (int c = 0; c < 3; ++c) {
      const double residual = residuals.at(v, c, BatchResiduals::kResidual, lane);
      sum += residual;
      all += residual * residual;
    }
    common += sum * sum / 3;
  }
  common_ += common / variance;
  other_ += (all - common) / variance;
  common_freedom_ += views - kCommonParameters;
  other_freedom_ += 2 * views - kOtherParameters;
}

void ResidualNoise::Add(const ResidualNoise& other) {
  common_ += other.common_;
  other_ += other.other_;
  common_freedom_ += other.common_freedom_;
  other_freedom_ += other.other_freedom_;
}

double ResidualNoise::Shared() const {
  if (common_freedom_ <= 0) return 1;
  const double common = common_ / common_freedom_, other = other_ / other_freedom_;
  if (!(common + other > 0)) return 1;
  return std::clamp(3 * common / (common + 2 * other), 1.0, 3.0);
}

}  // namespace glint
