// Small robust least-squares problems, as all fits of registration are.
#pragma once

#include <ceres/ceres.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <vector>

#include "base/model/solver.h"
#include "base/statistics/median.h"

namespace glint {

// (value − expected) / σ of N numbers.
template <size_t N>
struct ExpectedValues {
  std::array<double, N> value, sigma;
  template <class T>
  bool operator()(const T* x, T* residual) const {
    for (size_t i = 0; i < N; ++i) residual[i] = (x[i] - T(value[i])) / T(sigma[i]);
    return true;
  }
};

template <size_t N>
void AddPrior(const std::array<double, N>& value, const std::array<double, N>& sigma, double* block,
              ceres::Problem* problem) {
  problem->AddResidualBlock(
      new ceres::AutoDiffCostFunction<ExpectedValues<N>, N, N>(new ExpectedValues<N>{value, sigma}),
      nullptr, block);
}

// Cauchy's loss of residuals in σ, each counted `share` times. Problems leave it to its owner.
inline std::unique_ptr<ceres::LossFunction> RobustLoss(double share) {
  return std::make_unique<ceres::ScaledLoss>(new ceres::CauchyLoss(1), share,
                                             ceres::TAKE_OWNERSHIP);
}
inline ceres::Problem::Options SharingLosses() {
  ceres::Problem::Options options;
  options.loss_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
  return options;
}

inline void SolveRobustly(ceres::Problem* problem) {
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::DENSE_NORMAL_CHOLESKY;
  options.num_threads = 1;  // the same bits for the same input
  options.max_num_iterations = constants::kRobustIterations;
  options.function_tolerance = constants::kRobustTolerance;
  options.logging_type = ceres::SILENT;
  ceres::Solver::Summary summary;
  ceres::Solve(options, problem, &summary);
}

// Zero where it cannot be told.
inline Eigen::Matrix3d CovarianceOfBlock(const double* block, ceres::Problem* problem) {
  ceres::Covariance::Options options;
  options.num_threads = 1;
  ceres::Covariance covariance(options);
  Eigen::Matrix<double, 3, 3, Eigen::RowMajor> result = Eigen::Matrix3d::Zero();
  if (covariance.Compute(std::vector<std::pair<const double*, const double*>>{{block, block}},
                         problem)) {
    covariance.GetCovarianceBlock(block, block, result.data());
  }
  return result;
}

}  // namespace glint
