// Levenberg and Marquardt's steps for a model of a few pixels with many parameters.
#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <algorithm>

namespace glint {

// Minimises `sum_of_squares(p)` from `*p` on. `normal(p, &jtj, &jtr)` gives the normal equations,
// `bound(&trial)` brings a step back to where parameters may be, `settled(delta)` says that a step
// was too small to matter. False: the normal equations had no solution; `*p` is the best so far.
template <int kSize, class SumOfSquares, class Normal, class Bound, class Settled>
bool MinimizeDamped(const SumOfSquares& sum_of_squares, const Normal& normal, const Bound& bound,
                    const Settled& settled, Eigen::Matrix<double, kSize, 1>* p) {
  constexpr int kMaxSteps = 40;
  using Vector = Eigen::Matrix<double, kSize, 1>;
  using Matrix = Eigen::Matrix<double, kSize, kSize>;
  double cost = sum_of_squares(*p), damping = 1e-3;
  Matrix jtj;
  Vector jtr;
  bool fresh = true;
  for (int step = 0; step < kMaxSteps; ++step) {
    if (fresh) normal(*p, &jtj, &jtr);
    Matrix damped = jtj;
    damped.diagonal() += damping * jtj.diagonal() + Vector::Constant(1e-12);
    const Vector delta = -damped.ldlt().solve(jtr);
    if (!delta.allFinite()) return false;
    Vector trial = *p + delta;
    bound(&trial);
    const double trial_cost = sum_of_squares(trial);
    fresh = trial_cost <= cost;
    if (!fresh) {
      damping *= 8;
      if (damping > 1e8) return true;
      continue;
    }
    *p = trial;
    cost = trial_cost;
    damping = std::max(1e-9, damping / 5);
    if (settled(delta) && damping < 1e-4) return true;
  }
  return true;
}

// Takes parameters from `active` on out of the normal equations: they stay as they are.
template <int kSize>
void HoldFrom(int active, Eigen::Matrix<double, kSize, kSize>* jtj,
              Eigen::Matrix<double, kSize, 1>* jtr) {
  for (int i = active; i < kSize; ++i) {
    jtj->row(i).setZero();
    jtj->col(i).setZero();
    (*jtj)(i, i) = 1;
    (*jtr)[i] = 0;
  }
}

}  // namespace glint
