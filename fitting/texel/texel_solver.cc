#include "fitting/texel/texel_solver.h"

// The solver's products of 9×10 matrices: unrolled, rather than packed for a general product.
#define EIGEN_GEMM_TO_COEFFBASED_THRESHOLD 32
#include <ceres/tiny_solver.h>

#include <cmath>

#include "fitting/texel/texel_cost.h"
#include "fitting/texel/texel_parameters.h"

namespace glint {
namespace {

// Cholesky of the damped normal equations, keeping the zeros between channels. TinySolver's own
// choice, a pivoting LDLT, costs more than all residuals of 20 views.
class NormalCholesky {
 public:
  using Matrix = Eigen::Matrix<double, kTexelParameters, kTexelParameters>;
  using Vector = Eigen::Matrix<double, kTexelParameters, 1>;

  // matrix = Lᵀ·D·L with L unit upper triangular here: no square roots in the chain of pivots.
  void compute(const Matrix& matrix) {
    constexpr int n = kTexelParameters;
    for (int i = 0; i < n; ++i) {
      for (int j = i; j < n; ++j) factor_[i][j] = matrix(j, i);
    }
    for (int k = 0; k < n; ++k) {
      // The damping keeps pivots positive; a pivot lost to rounding makes a step of NaN, which the
      // solver rejects.
      const double inverse = 1.0 / factor_[k][k];
      inverse_[k] = inverse;
      // Rows of other channels' albedos have nothing in common with this one.
      const int first = k < kRough ? (k % 2 == 0 ? k + 1 : kRough) : k + 1;
      for (int i = first; i < n; i = i < kRough ? static_cast<int>(kRough) : i + 1) {
        const double across = factor_[k][i] * inverse;
        for (int j = i; j < n; ++j) factor_[i][j] -= across * factor_[k][j];
      }
    }
  }

  Vector solve(const Vector& right) const {
    constexpr int n = kTexelParameters;
    Vector x = right;
    for (int i = 0; i < n; ++i) {
      const double scaled = x[i] * inverse_[i];
      const int first = i < kRough ? (i % 2 == 0 ? i + 1 : kRough) : i + 1;
      for (int j = first; j < n; j = j < kRough ? static_cast<int>(kRough) : j + 1) {
        x[j] -= factor_[i][j] * scaled;
      }
    }
    for (int i = n - 1; i >= 0; --i) {
      const int first = i < kRough ? (i % 2 == 0 ? i + 1 : kRough) : i + 1;
      for (int j = first; j < n; j = j < kRough ? static_cast<int>(kRough) : j + 1) {
        x[i] -= factor_[i][j] * x[j];
      }
      x[i] *= inverse_[i];
    }
    return x;
  }

 private:
  double factor_[kTexelParameters][kTexelParameters];
  double inverse_[kTexelParameters];
};

using Solver = ceres::TinySolver<TexelCost, NormalCholesky>;

// Of a sum of squared logarithms: far below what 8 or 16 bit leave undetermined.
constexpr double kSquaresTolerance = 1e-9;
constexpr double kStepTolerance = 1e-6;
// Full Gauss–Newton steps from a rough start throw texels into corners that hold them (no specular
// at all; the smoothest lobe): with TinySolver's radius of 1e4 a third of texels ended in one, with
// 1 a twentieth (20 views), in no more steps.
constexpr double kFirstRadius = 1.0;

}  // namespace

struct TexelSolver::State {
  State(const KernelOptions& options_in, int most_iterations, int most_views)
      : options(options_in), rows(most_views) {
    solver.options.max_num_iterations = most_iterations;
    solver.options.function_tolerance = kSquaresTolerance;
    solver.options.parameter_tolerance = kStepTolerance;
    solver.options.gradient_tolerance = 1e-10;
    solver.options.cost_threshold = 1e-14;
    solver.options.initial_trust_region_radius = kFirstRadius;
  }

  EIGEN_MAKE_ALIGNED_OPERATOR_NEW
  KernelOptions options;
  KernelRows rows;
  Solver solver;
};

TexelSolver::TexelSolver(const KernelOptions& options, int most_iterations, int most_views)
    : state_(std::make_unique<State>(options, most_iterations, most_views)) {}

TexelSolver::~TexelSolver() = default;

void TexelSolver::SetTolerance(double squares) {
  state_->solver.options.function_tolerance = squares;
}

double TexelSolver::Cost(const TexelObservations& observations, const TexelPrior& prior,
                         const TexelValues& texel) {
  TexelGram gram;
  EvaluateGram(state_->options, observations, texel, &state_->rows, &gram);
  return 0.5 * (gram[kTexelParameters][kTexelParameters] + prior.SquaredNorm(texel));
}

void TexelSolver::Gram(const TexelObservations& observations, const TexelPrior& prior,
                       const TexelValues& texel, TexelGram* gram) {
  EvaluateGram(state_->options, observations, texel, &state_->rows, gram);
  prior.AddTo(texel, gram);
}

const KernelRows& TexelSolver::rows() const { return state_->rows; }

TexelSolution TexelSolver::Solve(const TexelObservations& observations, const TexelPrior& prior,
                                 const TexelValues& start) {
  const TexelCost cost(state_->options, observations, prior, &state_->rows);
  Solver::Parameters variables;
  ToVariables(start, variables.data());
  TexelSolution solution;
  TexelValues derivatives;
  // Starts at a bound are moved off it, where the variables have a slope.
  ToTexelValues(variables.data(), &solution.values, &derivatives);
  bool moved = false;
  for (int i = 0; i < kTexelParameters; ++i) {
    moved = moved || std::abs(solution.values[i] - start[i]) > 1e-12;
  }
  const Solver::Summary& summary = state_->solver.Solve(cost, &variables);
  ToTexelValues(variables.data(), &solution.values, &derivatives);
  solution.cost = summary.final_cost;
  solution.start_cost = moved ? Cost(observations, prior, start) : summary.initial_cost;
  solution.iterations = summary.iterations;
  solution.converged = summary.status != Solver::HIT_MAX_ITERATIONS;
  return solution;
}

}  // namespace glint
