#include "fitting/refine/residual_model.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "base/model/photographs.h"
#include "base/model/solver.h"
#include "base/reflectance/log_radiance.h"
#include "fitting/texel/texel_batch.h"

namespace glint {
namespace {

using constants::kCodeGamma;
using constants::kGaussianZeta;
using constants::kSensorNoise;

constexpr double kRadiansPerDegree = 3.14159265358979 / 180;

// exp(−θ²/2τ²) of the half vectors at the sample's centre, by pairs of views.
std::vector<std::vector<double>> HalfVectorLikeness(const RefineProblem& problem, double tau) {
  std::vector<TexelGeometry<double>> centre;
  for (const RefineView& view : problem.views) {
    centre.push_back(TexelGeometryInView<double>(view.view, problem.convention.falloff, 0, 0));
  }
  std::vector<std::vector<double>> likeness;
  for (const auto& a : centre) {
    std::vector<double>& row = likeness.emplace_back();
    for (const auto& b : centre) {
      const double angle = std::acos(std::clamp(Dot(a.half, b.half), -1.0, 1.0));
      row.push_back(std::exp(-angle * angle / (2 * tau * tau)));
    }
  }
  return likeness;
}

}  // namespace

double MeasurementVariance(const RefineProblem& problem) {
  double sum = 0, count = 0;
  for (const RefineView& view : problem.views) {
    const size_t step = std::max<size_t>(1, view.mask.size() / constants::kNoiseSamples);
    for (size_t i = 0; i < view.mask.size(); i += step) {
      if (!(view.mask[i] >= 0.5f)) continue;
      const double radiance = std::clamp<double>(view.rgb[view.mask.size() + i], 0, 1);
      // I = k^2.2, so dI = 2.2·I^(1.2/2.2)·dk with dk uniform over a 255th.
      const double by_code =
          kCodeGamma * std::pow(std::max(radiance, 1e-6), (kCodeGamma - 1) / kCodeGamma) / 255;
      const double rounding = view.ldr ? by_code / std::sqrt(12.0) : 0;
      const double offset = radiance + kLogOffset;
      sum += rounding * rounding / (offset * offset) + kSensorNoise * kSensorNoise;
      count += 1;
    }
  }
  return count > 0 ? sum / count : kSensorNoise * kSensorNoise;
}

double HyperbolicVariance(double mean_square, double robust_scale) {
  const double delta2 = robust_scale * robust_scale;
  const double wanted = mean_square / (2 * delta2);
  // K₀/K₁ + 1/ζ − 1 falls from ∞ to 0 as ζ rises; beyond the range it is 1/2ζ, Gauss's.
  double low = std::log(1e-3), high = std::log(kGaussianZeta);
  if (wanted <= 0.5 / kGaussianZeta) return mean_square;
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (low + high), zeta = std::exp(middle);
    const double here = std::cyl_bessel_k(0.0, zeta) / std::cyl_bessel_k(1.0, zeta) + 1 / zeta - 1;
    (here > wanted ? low : high) = middle;
  }
  return delta2 / std::exp(low);
}

double HyperbolicMeanSquare(double variance, double robust_scale) {
  const double delta2 = robust_scale * robust_scale;
  if (!(variance > 0) || delta2 / variance > kGaussianZeta) return variance;
  const double zeta = delta2 / variance;
  return variance * std::cyl_bessel_k(2.0, zeta) / std::cyl_bessel_k(1.0, zeta);
}

ResidualModel::ResidualModel(const RefineProblem& problem, const ResidualModelOptions& options)
    : options_(options),
      measurement_(MeasurementVariance(problem)),
      likeness_(HalfVectorLikeness(problem, options.half_vector_deg * kRadiansPerDegree)) {
  SetVariance(options.expected_sigma * options.expected_sigma);
}

void ResidualModel::SetVariance(double variance) {
  variance_ = std::max(variance, measurement_);
  const double smooth = options_.smooth_share * discrepancy_share();
  const auto n = static_cast<Eigen::Index>(likeness_.size());
  Eigen::MatrixXd correlation = Eigen::MatrixXd::Identity(n, n);
  for (Eigen::Index i = 0; i < n; ++i) {
    for (Eigen::Index j = 0; j < n; ++j) {
      if (i == j) continue;
      correlation(i, j) = smooth * likeness_[static_cast<size_t>(i)][static_cast<size_t>(j)];
    }
  }
  effective_views_ = correlation.ldlt().solve(Eigen::VectorXd::Ones(n)).sum();
}

double ResidualModel::discrepancy() const {
  return std::sqrt(std::max(0.0, variance_ - measurement_));
}

double ResidualModel::scale() const {
  const double channels = 1 + 2 * options_.channel_correlation * discrepancy_share();
  const double views = static_cast<double>(likeness_.size());
  return std::sqrt(variance_ * channels * views / effective_views_);
}

double DistinctViews(const RefineProblem& problem) {
  double alike = 0;
  for (const auto& row :
       HalfVectorLikeness(problem, ResidualModelOptions().half_vector_deg * kRadiansPerDegree)) {
    for (const double likeness : row) alike += likeness;
  }
  const double n = static_cast<double>(problem.views.size());
  return alike > 0 ? n * n / alike : 0;
}

}  // namespace glint
