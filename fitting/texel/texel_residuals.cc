#include "fitting/texel/texel_residuals.h"

#include <algorithm>
#include <cassert>

namespace glint {

void EvaluateTexelResiduals(const KernelOptions& options, const TexelObservations& observations,
                            const TexelPrior& prior, const TexelValues& texel, KernelRows* rows,
                            std::span<double> residuals, std::span<double> jacobian) {
  const int views = observations.views();
  assert(static_cast<int>(residuals.size()) == TexelResidualCount(observations));
  assert(jacobian.size() == residuals.size() * kTexelParameters);
  std::fill(jacobian.begin(), jacobian.end(), 0.0);
  EvaluateRows(options, observations, texel, rows);
  for (int v = 0; v < views; ++v) {
    for (int c = 0; c < 3; ++c) {
      const auto row = [&](int r) { return rows->row(c, r)[v]; };
      double* derivatives = jacobian.data() + (3 * v + c) * kTexelParameters;
      residuals[3 * v + c] = row(KernelRows::kResidual);
      derivatives[kSlopeX] = row(KernelRows::kBySlopeX);
      derivatives[kSlopeY] = row(KernelRows::kBySlopeY);
      derivatives[kRough] = row(KernelRows::kByRough);
      derivatives[DiffuseParameter(c)] = row(KernelRows::kByDiffuse);
      derivatives[SpecularParameter(c)] = row(KernelRows::kBySpecular);
    }
  }
  double held[kTexelParameters][kTexelParameters];
  prior.Evaluate(texel, residuals.data() + 3 * views, held);
  std::copy(&held[0][0], &held[0][0] + kTexelParameters * kTexelParameters,
            jacobian.data() + 3 * views * kTexelParameters);
}

}  // namespace glint
