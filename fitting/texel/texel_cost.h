// The residuals of one texel as ceres::TinySolver asks for them.
//
// A texel has 3·views + 9 residuals and 9 variables, but Levenberg–Marquardt sees of them only JᵀJ,
// Jᵀf and |f|². The kernel sums these products in one pass over the views; what the solver is
// handed is their Cholesky factor: ten residuals f' and a 10×9 Jacobian J' with J'ᵀJ' = JᵀJ,
// J'ᵀf' = Jᵀf and |f'| = |f|. So every solve has one fixed size, whatever the number of views, and
// allocates nothing.
#pragma once

#include <Eigen/Core>

#include "fitting/texel/texel_kernel.h"
#include "fitting/texel/texel_prior.h"

namespace glint {

class TexelCost {
 public:
  using Scalar = double;
  enum { NUM_RESIDUALS = kGramSize, NUM_PARAMETERS = kTexelParameters };

  TexelCost(const KernelOptions& options, const TexelObservations& observations,
            const TexelPrior& prior, KernelRows* rows)
      : options_(options), observations_(observations), prior_(prior), rows_(rows) {}

  // `jacobian` column-major, kGramSize × kTexelParameters; may be null.
  bool operator()(const double* variables, double* residuals, double* jacobian) const;

 private:
  void Evaluate(const double* variables) const;

  const KernelOptions& options_;
  const TexelObservations& observations_;
  const TexelPrior& prior_;
  KernelRows* rows_;
  // The solver asks for the cost of a step and, when it takes the step, for the derivatives at the
  // same place: those were summed with the cost.
  mutable TexelGram gram_;
  mutable TexelValues evaluated_;
  mutable bool evaluated_valid_ = false;
};

// Upper triangular `factor` with factorᵀ·factor = gram; directions without any weight become rows
// of zeros.
void FactorGram(const TexelGram& gram, TexelGram* factor);

}  // namespace glint
