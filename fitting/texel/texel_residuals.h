// All residuals of a texel one by one with their Jacobian, for a general solver and for tests;
// texel_cost.h hands the same sums of squares to TinySolver in a smaller form.
#pragma once

#include <span>

#include "fitting/texel/texel_kernel.h"
#include "fitting/texel/texel_prior.h"

namespace glint {

inline int TexelResidualCount(const TexelObservations& observations) {
  return 3 * observations.views() + kTexelParameters;
}

// Residuals: view by view, channel R, G, B of each; then the prior's. `jacobian` by the physical
// values, row-major [residuals × kTexelParameters].
void EvaluateTexelResiduals(const KernelOptions& options, const TexelObservations& observations,
                            const TexelPrior& prior, const TexelValues& texel, KernelRows* rows,
                            std::span<double> residuals, std::span<double> jacobian);

}  // namespace glint
