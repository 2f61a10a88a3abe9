// H·step = −gradient, the normal equations of a sum of squares.
#pragma once

#include <Eigen/Core>
#include <utility>
#include <vector>

namespace glint {

struct NormalEquations {
  explicit NormalEquations(int size)
      : hessian(Eigen::MatrixXd::Zero(size, size)), gradient(Eigen::VectorXd::Zero(size)) {}

  // One residual and its derivatives by a few unknowns.
  void Add(double residual, const std::vector<std::pair<int, double>>& derivatives) {
    for (const auto& [i, by_i] : derivatives) {
      gradient[i] += by_i * residual;
      for (const auto& [j, by_j] : derivatives) hessian(i, j) += by_i * by_j;
    }
  }

  Eigen::MatrixXd hessian;
  Eigen::VectorXd gradient;
};

}  // namespace glint
