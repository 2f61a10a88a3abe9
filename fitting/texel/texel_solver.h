// Least squares of one texel: Levenberg–Marquardt on the variables of texel_parameters.h.
#pragma once

#include "fitting/texel/texel_kernel.h"
#include "fitting/texel/texel_prior.h"

namespace glint {

struct TexelSolution {
  TexelValues values{};
  double start_cost = 0;  // of the start as it was given
  double cost = 0;        // half the sum of squared residuals, prior included
  int iterations = 0;
  bool converged = false;
};

// Everything one thread needs to solve texel after texel without allocating.
class TexelSolver {
 public:
  TexelSolver(const KernelOptions& options, int most_iterations, int most_views);

  // A step that lowers the sum of squared residuals by less ends a solve.
  void SetTolerance(double squares) { squares_tolerance_ = squares; }

  // Cost of `texel` as it is.
  double Cost(const TexelObservations& observations, const TexelPrior& prior,
              const TexelValues& texel);
  // The local minimum that Levenberg–Marquardt reaches from `start`, drawn off its bounds.
  // `damping`: of the first step, relative to the diagonal of the normal equations.
  TexelSolution Solve(const TexelObservations& observations, const TexelPrior& prior,
                      const TexelValues& start, double damping = kRoughStart);

  // Full Gauss–Newton steps from a rough start throw texels into corners that hold them (no
  // specular at all; the smoothest lobe): with a damping of 1e-4 a third of texels ended in one,
  // with 1 a twentieth (20 views), in no more steps. Next to a minimum they are what is wanted.
  static constexpr double kRoughStart = 1, kNearMinimum = 0.01;
  // [J f]ᵀ[J f] by the physical values, prior included.
  void Gram(const TexelObservations& observations, const TexelPrior& prior,
            const TexelValues& texel, TexelGram* gram);
  // The photographs' residuals and derivatives of the last Cost or Gram.
  const KernelRows& rows() const { return rows_; }

 private:
  KernelOptions options_;
  int most_iterations_;
  double squares_tolerance_;
  KernelRows rows_;
};

}  // namespace glint
