// What is expected of texels and corrections beforehand, for Ceres.
#pragma once

#include <ceres/sized_cost_function.h>

#include <algorithm>
#include <array>

#include "fitting/view_correction/radiance_cost.h"

namespace glint {

// Standard deviations expected of the start's errors: a hold that only settles what the views do
// not tell.
inline constexpr double kTexelSigma[kTexelSize] = {0.1, 0.1, 0.1, 0.1, 0.1, 0.1, 0.2, 0.2, 0.2};

// Residuals (parameter − mean)/σ of one block.
template <int kSize>
class Hold : public ceres::SizedCostFunction<kSize, kSize> {
 public:
  Hold(const double* mean, const double* sigmas) {
    std::copy_n(mean, kSize, mean_.begin());
    std::copy_n(sigmas, kSize, sigmas_.begin());
  }
  bool Evaluate(double const* const* parameters, double* residuals,
                double** jacobians) const override {
    for (int i = 0; i < kSize; ++i) {
      residuals[i] =
          (parameters[0][i] - mean_[static_cast<size_t>(i)]) / sigmas_[static_cast<size_t>(i)];
    }
    if (!jacobians || !jacobians[0]) return true;
    std::fill_n(jacobians[0], kSize * kSize, 0.0);
    for (int i = 0; i < kSize; ++i)
      jacobians[0][i * kSize + i] = 1 / sigmas_[static_cast<size_t>(i)];
    return true;
  }

 private:
  std::array<double, kSize> mean_, sigmas_;
};

// The least turn that takes z to `direction` (row-major): what is beside an upright camera's lens,
// in the sample's frame.
inline std::array<double, 9> TurnOf(const Vec3d& direction) {
  const double x = direction[0], y = direction[1], z = direction[2];
  const double s = 1 / (1 + std::max(-0.999, z));
  return {1 - x * x * s, -x * y * s, x, -x * y * s, 1 - y * y * s, y, -x, -y, z};
}

// What a light's offset has of its own, beside the one that all lights share: across the light's
// direction and along it. Blocks: the light's offset, the shared one in the light's frame.
class LightHold : public ceres::SizedCostFunction<3, 3, 3> {
 public:
  LightHold(const Vec3d& direction, double across, double along) {
    const std::array<double, 9> turn = TurnOf(direction);
    for (size_t i = 0; i < 3; ++i) {
      for (size_t j = 0; j < 3; ++j) {
        const double projection = direction[i] * direction[j];
        own_[3 * i + j] = ((i == j ? 1 : 0) - projection) / across + projection / along;
      }
    }
    for (size_t i = 0; i < 3; ++i) {
      for (size_t j = 0; j < 3; ++j) {
        shared_[3 * i + j] = 0;
        for (size_t k = 0; k < 3; ++k) shared_[3 * i + j] -= own_[3 * i + k] * turn[3 * k + j];
      }
    }
  }
  bool Evaluate(double const* const* parameters, double* residuals,
                double** jacobians) const override {
    for (size_t i = 0; i < 3; ++i) {
      residuals[i] = 0;
      for (size_t j = 0; j < 3; ++j) {
        residuals[i] += own_[3 * i + j] * parameters[0][j] + shared_[3 * i + j] * parameters[1][j];
      }
    }
    if (jacobians && jacobians[0]) std::copy(own_.begin(), own_.end(), jacobians[0]);
    if (jacobians && jacobians[1]) std::copy(shared_.begin(), shared_.end(), jacobians[1]);
    return true;
  }

 private:
  std::array<double, 9> own_, shared_;
};

// A texel's departure from its start, but for a tilt that all texels share. Blocks: texel, tilt.
class TexelHold : public ceres::SizedCostFunction<kTexelSize, kTexelSize, 2> {
 public:
  explicit TexelHold(const double* start) { std::copy_n(start, kTexelSize, start_.begin()); }
  bool Evaluate(double const* const* parameters, double* residuals,
                double** jacobians) const override {
    for (int i = 0; i < kTexelSize; ++i) {
      const double tilt = i >= kTexelSlope ? parameters[1][i - kTexelSlope] : 0;
      residuals[i] = (parameters[0][i] - start_[static_cast<size_t>(i)] - tilt) / kTexelSigma[i];
    }
    if (!jacobians) return true;
    if (jacobians[0]) std::fill_n(jacobians[0], kTexelSize * kTexelSize, 0.0);
    if (jacobians[1]) std::fill_n(jacobians[1], kTexelSize * 2, 0.0);
    for (int i = 0; i < kTexelSize; ++i) {
      if (jacobians[0]) jacobians[0][i * kTexelSize + i] = 1 / kTexelSigma[i];
      if (jacobians[1] && i >= kTexelSlope) {
        jacobians[1][i * 2 + i - kTexelSlope] = -1 / kTexelSigma[i];
      }
    }
    return true;
  }

 private:
  std::array<double, kTexelSize> start_;
};

}  // namespace glint
