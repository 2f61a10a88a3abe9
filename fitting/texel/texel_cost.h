// The cost of one texel as the solver sees it: by the unbounded variables of texel_parameters.h.
//
// A texel has 3·views + 9 residuals f, but Levenberg–Marquardt sees of them only JᵀJ, Jᵀf and |f|².
// The kernel sums these products in one pass over the views, so that every solve has one fixed
// size, whatever the number of views, and allocates nothing.
#pragma once

#include "fitting/texel/texel_kernel.h"
#include "fitting/texel/texel_prior.h"

namespace glint {

// [J f]ᵀ[J f] of photographs and prior, J by the variables.
void EvaluateCost(const KernelOptions& options, const TexelObservations& observations,
                  const TexelPrior& prior, const double variables[kTexelParameters],
                  KernelRows* rows, TexelGram* gram);

// Half the sum of squared residuals.
inline double CostOf(const TexelGram& gram) {
  return 0.5 * gram[kTexelParameters][kTexelParameters];
}

}  // namespace glint
