#include "fitting/texel/texel_cost.h"

#include "fitting/texel/texel_parameters.h"

namespace glint {

void EvaluateCost(const KernelOptions& options, const TexelObservations& observations,
                  const TexelPrior& prior, const double variables[kTexelParameters],
                  KernelRows* rows, TexelGram* gram) {
  TexelValues values, derivatives;
  ToTexelValues(variables, &values, &derivatives);
  EvaluateGram(options, observations, values, rows, gram);
  prior.AddTo(values, gram);
  for (int i = 0; i < kTexelParameters; ++i) {
    if (derivatives[i] == 1.0) continue;
    for (int j = 0; j <= i; ++j) (*gram)[j][i] *= derivatives[i];
    for (int j = i; j < kGramSize; ++j) (*gram)[i][j] *= derivatives[i];
  }
}

}  // namespace glint
