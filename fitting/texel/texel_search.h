// More than one start per texel: the local minimum next to the start need not be the best.
#pragma once

#include <span>

#include "fitting/texel/texel_albedos.h"
#include "fitting/texel/texel_solver.h"

namespace glint {

// Solver with memory for one thread; see texel_solver.h.
class TexelSearch {
 public:
  TexelSearch(const KernelOptions& options, int most_iterations, int most_views, int starts);

  // Texels whose residuals are no larger are not searched further; 0 to begin with.
  void SetExplained(double residual_sigma) { variance_ = residual_sigma * residual_sigma; }
  // The same, and solves end when they gain a small part of such a residual's square.
  void SetNoise(double residual_sigma);

  // Whether the cost of a texel seen in `views` leaves room for a better minimum.
  bool Unexplained(int views, double cost) const;

  struct Found {
    TexelSolution solution;
    double start_cost = 0;     // of the start as it was given
    bool other_start = false;  // it did not come from the start itself
  };

  // The best local minimum among those reached from `start` and from up to `starts − 1` other
  // roughnesses, each with albedos fitted to it. Never costlier than `start`.
  Found FromStart(const TexelObservations& observations, const TexelPrior& prior,
                  const TexelValues& start);

  // The local minimum near `values`, which are next to one, or they themselves where that is no
  // less costly; `converged` is whether they were.
  TexelSolution Improved(const TexelObservations& observations, const TexelPrior& prior,
                         const TexelValues& values, bool converged);

  // The best of `current` and the minimum near the neighbour that promises least: its normal and
  // roughness, or its roughness alone, with albedos fitted to this texel.
  Found FromNeighbours(const TexelObservations& observations, const TexelPrior& prior,
                       const TexelSolution& current, std::span<const TexelValues> neighbours);

  TexelSolver& solver() { return solver_; }

 private:
  struct Candidate {
    TexelValues values;
    AlbedoFit fit;
  };
  // `values` with albedos fitted to the texel.
  Candidate WithFittedAlbedos(const TexelObservations& observations, const TexelPrior& prior,
                              const TexelValues& values);
  // From `from` with other roughnesses.
  void TryRoughnesses(const TexelObservations& observations, const TexelPrior& prior,
                      const TexelValues& from, Found* best);
  bool TrySolve(const TexelObservations& observations, const TexelPrior& prior,
                const TexelValues& from, TexelSolution* best);

  KernelOptions options_;
  int starts_;
  double variance_ = 0.0;
  TexelSolver solver_;
  KernelRows rows_;
};

}  // namespace glint
