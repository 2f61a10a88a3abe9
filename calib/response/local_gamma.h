// The parametrisation of response.h: θ at knots to g and its derivatives. Not for other folders.
#pragma once

#include <Eigen/Core>

namespace glint::response {

// g(v) and ∂g/∂θ on a fixed grid of v, by the trapezoid rule in u; between grid points linear in v.
class LocalGamma {
 public:
  LocalGamma(int knots, double lowest);

  void Set(const Eigen::VectorXd& theta);
  double Theta(double v) const;
  double G(double v) const;                     // v in [lowest, 1]
  Eigen::RowVectorXd Gradient(double v) const;  // of G

 private:
  // Grid interval of v and the share of its right end.
  std::pair<int, double> Find(double v) const;

  int knots_;
  double lowest_, step_;
  Eigen::VectorXd theta_, g_;
  Eigen::MatrixXd gradient_;  // [grid, knots]
};

}  // namespace glint::response
