// Inside of glint_texel: the functions that work on all lanes of a batch, and their choice by
// instruction set. One source (batch_kernel.inl) is compiled once for each set.
//
// With R the rendered and I the photographed radiance of a view and channel,
//   e = min(log(R + 0.01) − log(I + 0.01), ceiling),       residual = √weight · g(e)
//   g(e) = e · √(2 / (1 + √(1 + (e/δ)²))),                 so that g²/2 is Charbonnier's loss
//                                                          δ²(√(1 + (e/δ)²) − 1):
// quadratic within the robust scale δ, linear beyond (Charbonnier et al., "Two deterministic
// half-quadratic regularization algorithms", ICIP 1994). g is smooth, so that a plain least-squares
// solver minimises the robust cost itself and needs no reweighting.
#pragma once

#include "base/cpu/instruction_set.h"
#include "base/model/solver.h"
#include "fitting/texel/texel_batch.h"

namespace glint::kernel {

// One bit for each lane.
using LaneBits = unsigned;
inline constexpr LaneBits kAllLanes = (1u << kBatch) - 1;

struct SolveOptions {
  int most_iterations = constants::kSolveIterations;
  // Where no step promises to lower the sum of squared residuals by so much a solve ends. A sum of
  // squared logarithms: far below what 8 or 16 bit leave undetermined. At least what single
  // precision rounds the sum by.
  float squares_tolerance = constants::kSquaresTolerance;
  // Of the first step, relative to the diagonal of the normal equations.
  float damping = constants::kFarDamping;
};

// Solves of each lane, and where they stand.
struct BatchSolution {
  BatchValues values;         // the start, then the best so far
  BatchRow start_cost, cost;  // half sums of squared residuals, prior included; the start's is of
                              // where it was drawn off its bounds
  LaneBits converged = 0;
  LaneBits finished = 0;  // converged, or given up
  // Of the solver: what it needs to go on.
  BatchValues variables, least_diagonal;
  BatchRow damping, growth, iterations;

  void CopyLane(const BatchSolution& from, int from_lane, int lane);
};

enum class Solving {
  kBegin,     // from `values`; until a vector has less than half of its lanes left
  kContinue,  // likewise, from where it stands
  kFinish     // from where it stands, all lanes
};

// Observations, and memory for kScratchRows rows of each view.
struct BatchViews {
  static constexpr int kScratchRows = 11;
  const BatchRow* rows;  // BatchObservations::rows()
  int count;
  BatchRow* scratch;
};

struct BatchKernel {
  // Of one view: geometry of lanes at place_mm[x, y], and the radiances' logarithms and inverses.
  void (*complete)(const BatchView& view, const BatchRow place_mm[2], BatchRow* planes);
  // The products at `values`, of the photographs alone. `residuals`, unless null: rows of
  // BatchResiduals.
  void (*gram)(const KernelOptions& options, const BatchViews& views, const BatchValues& values,
               BatchGram* gram, BatchRow* residuals);
  // (photographs + prior + least·1)⁻¹ by the physical values.
  void (*inverse)(const BatchGram& photographs, const BatchPrior& prior, const BatchValues& values,
                  float least, BatchInverse* inverse);
  // Toward the local minima that Levenberg–Marquardt reaches, of the lanes in `active`; the others
  // stay as they are. What a lane comes to does not depend on the others.
  void (*solve)(const KernelOptions& options, const SolveOptions& solve, const BatchViews& views,
                const BatchPrior& prior, LaneBits active, Solving how, BatchSolution* solution);
  // AlbedoSums (texel_albedos.h).
  void (*albedo_sums)(const KernelOptions& options, const BatchViews& views,
                      const BatchValues& values, BatchAlbedoSums* sums);
};

const BatchKernel& BatchKernelFor(InstructionSet set);

}  // namespace glint::kernel
