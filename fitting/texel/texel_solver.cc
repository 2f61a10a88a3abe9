#include "fitting/texel/texel_solver.h"

#include <algorithm>
#include <cmath>

#include "fitting/texel/texel_cholesky.h"
#include "fitting/texel/texel_cost.h"
#include "fitting/texel/texel_parameters.h"

namespace glint {
namespace {

// Of a sum of squared logarithms: far below what 8 or 16 bit leave undetermined.
constexpr double kSquaresTolerance = 1e-9;
constexpr double kStepTolerance = 1e-6;
constexpr double kGradientTolerance = 1e-10;  // by scaled variables
constexpr double kExactCost = 1e-14;          // nothing to gain

using Variables = double[kTexelParameters];

// Levenberg–Marquardt with Nielsen's update of the damping (Madsen, Nielsen and Tingleff, "Methods
// for non-linear least squares problems", 2004, algorithm 3.16) and a fixed scale of each variable,
// 1/(1 + |column of J|) at the start.
class LevenbergMarquardt {
 public:
  // evaluate(variables, gram): see EvaluateCost.
  template <class Evaluate>
  LevenbergMarquardt(const Evaluate& evaluate, int most_iterations, double squares_tolerance,
                     double damping, Variables* variables) {
    TexelGram tried;
    Variables& x = *variables;
    evaluate(x, &gram_);
    start_cost = CostOf(gram_);
    if (!std::isfinite(start_cost)) return;
    for (int i = 0; i < kTexelParameters; ++i) scale_[i] = 1.0 / (1.0 + std::sqrt(gram_[i][i]));
    double growth = 2.0;
    while (!Minimal()) {
      if (++iterations >= most_iterations) return;
      Variables step, at;
      const double expected = Propose(damping, &step);
      double step_squares = 0.0, squares = 0.0;
      for (int i = 0; i < kTexelParameters; ++i) {
        step_squares += step[i] * step[i];
        squares += x[i] * x[i];
        at[i] = x[i] + step[i];
      }
      if (std::sqrt(step_squares) < kStepTolerance * (std::sqrt(squares) + kStepTolerance)) break;
      evaluate(at, &tried);
      const double gain = 2.0 * (CostOf(gram_) - CostOf(tried));
      if (!(gain > 0.0 && expected > 0.0)) {  // not a number, or uphill
        damping *= growth;
        growth *= 2.0;
        continue;
      }
      std::copy_n(at, kTexelParameters, x);
      gram_ = tried;
      if (gain < squares_tolerance) break;
      const double beyond = 2.0 * gain / expected - 1.0;
      damping *= std::max(1.0 / 3.0, 1.0 - beyond * beyond * beyond);
      growth = 2.0;
    }
    converged = true;
  }

  double cost() const { return CostOf(gram_); }
  double start_cost = 0.0;
  int iterations = 0;
  bool converged = false;

 private:
  bool Minimal() const {
    double most = 0.0;
    for (int i = 0; i < kTexelParameters; ++i) {
      most = std::max(most, std::abs(gram_[i][kTexelParameters] * scale_[i]));
    }
    return most < kGradientTolerance || cost() < kExactCost;
  }

  // The damped step, and by how much it lowers the squares of the linear model.
  double Propose(double damping, Variables* step) const {
    constexpr double kLeastDiagonal = 1e-6;  // by scaled variables
    Variables added, descent;
    for (int i = 0; i < kTexelParameters; ++i) {
      added[i] = damping * std::max(gram_[i][i], kLeastDiagonal / (scale_[i] * scale_[i]));
      descent[i] = -gram_[i][kTexelParameters];
    }
    TexelCholesky(gram_, added).Solve(descent, step);
    // 2·gᵀs − sᵀJᵀJs with (JᵀJ + D)s = g
    double expected = 0.0;
    for (int i = 0; i < kTexelParameters; ++i) {
      expected += (*step)[i] * (descent[i] + added[i] * (*step)[i]);
    }
    return expected;
  }

  TexelGram gram_;
  double scale_[kTexelParameters];
};

}  // namespace

TexelSolver::TexelSolver(const KernelOptions& options, int most_iterations, int most_views)
    : options_(options),
      most_iterations_(most_iterations),
      squares_tolerance_(kSquaresTolerance),
      rows_(most_views) {}

double TexelSolver::Cost(const TexelObservations& observations, const TexelPrior& prior,
                         const TexelValues& texel) {
  TexelGram gram;
  EvaluateGram(options_, observations, texel, &rows_, &gram);
  return 0.5 * (gram[kTexelParameters][kTexelParameters] + prior.SquaredNorm(texel));
}

void TexelSolver::Gram(const TexelObservations& observations, const TexelPrior& prior,
                       const TexelValues& texel, TexelGram* gram) {
  EvaluateGram(options_, observations, texel, &rows_, gram);
  prior.AddTo(texel, gram);
}

TexelSolution TexelSolver::Solve(const TexelObservations& observations, const TexelPrior& prior,
                                 const TexelValues& start, double damping) {
  Variables variables;
  ToVariables(start, variables);
  TexelSolution solution;
  TexelValues derivatives;
  // Starts at a bound are moved off it, where the variables have a slope.
  ToTexelValues(variables, &solution.values, &derivatives);
  bool moved = false;
  for (int i = 0; i < kTexelParameters; ++i) {
    moved = moved || std::abs(solution.values[i] - start[i]) > 1e-12;
  }
  const LevenbergMarquardt solved(
      [&](const Variables& at, TexelGram* gram) {
        EvaluateCost(options_, observations, prior, at, &rows_, gram);
      },
      most_iterations_, squares_tolerance_, damping, &variables);
  ToTexelValues(variables, &solution.values, &derivatives);
  solution.cost = solved.cost();
  solution.start_cost = moved ? Cost(observations, prior, start) : solved.start_cost;
  solution.iterations = solved.iterations;
  solution.converged = solved.converged;
  return solution;
}

}  // namespace glint
