#include "fitting/view_correction/bounded_step.h"

#include <Eigen/Cholesky>
#include <vector>

namespace glint {
namespace {

// Primal active sets: every round walks from a step within the bounds towards the minimum over what
// is free, as far as the first bound, and holds what met it; or, at that minimum, lets one value go
// that would rather move inward.
class ActiveSets {
 public:
  ActiveSets(const Eigen::MatrixXd& a, const Eigen::VectorXd& g, const Eigen::VectorXd& least,
             const Eigen::VectorXd& most)
      : a_(a),
        g_(g),
        least_(least),
        most_(most),
        held_(static_cast<size_t>(g.size()), false),
        step_(Eigen::VectorXd::Zero(g.size()).cwiseMax(least).cwiseMin(most)) {}

  Eigen::VectorXd Solve() {
    // Every value is held and let go once in a while; a rounding error could do so for ever.
    const Eigen::Index most_rounds = 20 * g_.size();
    for (Eigen::Index round = 0; round < most_rounds; ++round) {
      if (!WalkToBound(MinimumOfFree()) && !Release()) break;
    }
    return step_;
  }

 private:
  bool held(Eigen::Index i) const { return held_[static_cast<size_t>(i)]; }

  Eigen::VectorXd MinimumOfFree() const {
    Eigen::MatrixXd matrix = a_;
    Eigen::VectorXd right = g_;
    for (Eigen::Index i = 0; i < g_.size(); ++i) {
      if (held(i)) right -= a_.col(i) * step_[i];
    }
    for (Eigen::Index i = 0; i < g_.size(); ++i) {
      if (!held(i)) continue;
      matrix.col(i).setZero();
      matrix.row(i).setZero();
      matrix(i, i) = 1;
      right[i] = step_[i];
    }
    return matrix.ldlt().solve(right);
  }

  // False where `to` is within the bounds.
  bool WalkToBound(const Eigen::VectorXd& to) {
    double way = 1;
    Eigen::Index met = -1;
    for (Eigen::Index i = 0; i < g_.size(); ++i) {
      if (held(i) || (to[i] >= least_[i] && to[i] <= most_[i])) continue;
      const double bound = to[i] < least_[i] ? least_[i] : most_[i];
      const double until = (bound - step_[i]) / (to[i] - step_[i]);
      if (met < 0 || until < way) way = until, met = i;
    }
    for (Eigen::Index i = 0; i < g_.size(); ++i) {
      if (!held(i)) step_[i] += way * (to[i] - step_[i]);
    }
    if (met < 0) return false;
    step_[met] = to[met] < least_[met] ? least_[met] : most_[met];
    held_[static_cast<size_t>(met)] = true;
    return true;
  }

  // False where nothing that is held would rather move inward.
  bool Release() {
    const Eigen::VectorXd slope = a_ * step_ - g_;
    double steepest = 0;
    Eigen::Index released = -1;
    for (Eigen::Index i = 0; i < g_.size(); ++i) {
      if (!held(i) || least_[i] == most_[i]) continue;
      const double inward = step_[i] == least_[i] ? -slope[i] : slope[i];
      if (inward > steepest) steepest = inward, released = i;
    }
    if (released < 0) return false;
    held_[static_cast<size_t>(released)] = false;
    return true;
  }

  const Eigen::MatrixXd& a_;
  const Eigen::VectorXd &g_, &least_, &most_;
  std::vector<bool> held_;
  Eigen::VectorXd step_;
};

}  // namespace

Eigen::VectorXd StepWithin(const Eigen::MatrixXd& a, const Eigen::VectorXd& g,
                           const Eigen::VectorXd& least, const Eigen::VectorXd& most) {
  return ActiveSets(a, g, least, most).Solve();
}

}  // namespace glint
