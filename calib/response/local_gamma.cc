#include "calib/response/local_gamma.h"

#include <algorithm>
#include <cmath>

namespace glint::response {
namespace {
constexpr int kCells = 2040;  // eight to a code
}

LocalGamma::LocalGamma(int knots, double lowest)
    : knots_(knots), lowest_(lowest), step_((1 - lowest) / kCells) {}

std::pair<int, double> LocalGamma::Find(double v) const {
  const double at = std::clamp((v - lowest_) / step_, 0.0, static_cast<double>(kCells));
  const int i = std::min(static_cast<int>(at), kCells - 1);
  return {i, at - i};
}

double LocalGamma::Theta(double v) const {
  const double at = std::clamp(v, 0.0, 1.0) * (knots_ - 1);
  const int k = std::min(static_cast<int>(at), knots_ - 2);
  return theta_[k] + (at - k) * (theta_[k + 1] - theta_[k]);
}

void LocalGamma::Set(const Eigen::VectorXd& theta) {
  theta_ = theta;
  g_ = Eigen::VectorXd::Zero(kCells + 1);
  gradient_ = Eigen::MatrixXd::Zero(kCells + 1, knots_);
  // From the bright end, where g is 0; half a step's share of each end of an interval.
  for (int i = kCells - 1; i >= 0; --i) {
    g_[i] = g_[i + 1];
    gradient_.row(i) = gradient_.row(i + 1);
    for (const int end : {i, i + 1}) {
      const double u = lowest_ + end * step_;
      const double share = 0.5 * step_ * std::exp(Theta(u)) / u;
      g_[i] -= share;
      const double at = u * (knots_ - 1);
      const int k = std::min(static_cast<int>(at), knots_ - 2);
      gradient_(i, k) -= share * (1 - (at - k));
      gradient_(i, k + 1) -= share * (at - k);
    }
  }
}

double LocalGamma::G(double v) const {
  const auto [i, t] = Find(v);
  return g_[i] + t * (g_[i + 1] - g_[i]);
}

Eigen::RowVectorXd LocalGamma::Gradient(double v) const {
  const auto [i, t] = Find(v);
  return (1 - t) * gradient_.row(i) + t * gradient_.row(i + 1);
}

}  // namespace glint::response
