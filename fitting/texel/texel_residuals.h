// All residuals of a texel one by one with their Jacobian, for a general solver and for tests.
// The solver sees their products only (texel_cost.h).
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
