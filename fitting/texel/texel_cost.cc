#include "fitting/texel/texel_cost.h"

#include <algorithm>
#include <cmath>

#include "fitting/texel/texel_parameters.h"

namespace glint {

void FactorGram(const TexelGram& gram, TexelGram* factor) {
  constexpr double kRankTolerance = 1e-14;
  TexelGram& f = *factor;
  for (int i = 0; i < kGramSize; ++i) {
    for (int j = i; j < kGramSize; ++j) f[i][j] = gram[i][j];
  }
  // LDLᵀ first, then all square roots at once: they do not wait for each other.
  double scale[kGramSize];
  for (int k = 0; k < kGramSize; ++k) {
    const double pivot = f[k][k];
    // The last pivot is the squared residual that no step can remove: zero at an exact fit.
    const bool usable = pivot > kRankTolerance * gram[k][k];
    scale[k] = usable ? 1.0 / pivot : 0.0;
    // Rows of other channels' albedos have nothing in common with this one.
    const int first = k < kRough ? (k % 2 == 0 ? k + 1 : kRough) : k + 1;
    for (int i = first; i < kGramSize; i = i < kRough ? static_cast<int>(kRough) : i + 1) {
      const double across = f[k][i] * scale[k];
      for (int j = i; j < kGramSize; ++j) f[i][j] -= across * f[k][j];
    }
  }
  for (int k = 0; k < kGramSize; ++k) {
    const double root = std::sqrt(scale[k]);
    for (int j = k; j < kGramSize; ++j) f[k][j] *= root;
  }
}

void TexelCost::Evaluate(const double* variables) const {
  if (evaluated_valid_ && std::equal(evaluated_.begin(), evaluated_.end(), variables)) return;
  TexelValues values, derivatives;
  ToTexelValues(variables, &values, &derivatives);
  EvaluateGram(options_, observations_, values, rows_, &gram_);
  prior_.AddTo(values, &gram_);
  for (int i = 0; i < kTexelParameters; ++i) {
    if (derivatives[i] == 1.0) continue;
    for (int j = 0; j <= i; ++j) gram_[j][i] *= derivatives[i];
    for (int j = i; j < kGramSize; ++j) gram_[i][j] *= derivatives[i];
  }
  std::copy(variables, variables + kTexelParameters, evaluated_.begin());
  evaluated_valid_ = true;
}

bool TexelCost::operator()(const double* variables, double* residuals, double* jacobian) const {
  Evaluate(variables);
  if (jacobian == nullptr) {  // only the norm is asked for
    std::fill(residuals, residuals + kGramSize, 0.0);
    residuals[0] = std::sqrt(gram_[kTexelParameters][kTexelParameters]);
    return true;
  }
  TexelGram factor;
  FactorGram(gram_, &factor);
  for (int j = 0; j < kGramSize; ++j) {
    double* column = j < kTexelParameters ? jacobian + j * kGramSize : residuals;
    for (int i = 0; i <= j; ++i) column[i] = factor[i][j];
    for (int i = j + 1; i < kGramSize; ++i) column[i] = 0.0;
  }
  return true;
}

}  // namespace glint
