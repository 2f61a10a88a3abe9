// Cholesky factor of a texel's normal equations.
#pragma once

#include "fitting/texel/texel_kernel.h"

namespace glint {

// matrix = Lᵀ·D·L with L unit upper triangular: no square roots in the chain of pivots. Zeros
// between channels, whose albedos have nothing in common, stay zeros and are skipped.
class TexelCholesky {
 public:
  using Vector = double[kTexelParameters];

  // Of the leading kTexelParameters rows of `matrix` with `damping` added to the diagonal. Where a
  // pivot is lost to rounding, solutions are wrong or not numbers: judge them.
  TexelCholesky(const TexelGram& matrix, const Vector& damping) {
    for (int i = 0; i < kTexelParameters; ++i) {
      for (int j = i; j < kTexelParameters; ++j) factor_[i][j] = matrix[i][j];
      factor_[i][i] += damping[i];
    }
    for (int k = 0; k < kTexelParameters; ++k) {
      inverse_[k] = 1.0 / factor_[k][k];
      for (int i = After(k, k); i < kTexelParameters; i = After(k, i)) {
        const double across = factor_[k][i] * inverse_[k];
        for (int j = i; j < kTexelParameters; ++j) factor_[i][j] -= across * factor_[k][j];
      }
    }
  }

  void Solve(const Vector& right, Vector* solution) const {
    Vector& x = *solution;
    for (int i = 0; i < kTexelParameters; ++i) x[i] = right[i];
    for (int i = 0; i < kTexelParameters; ++i) {
      const double scaled = x[i] * inverse_[i];
      for (int j = After(i, i); j < kTexelParameters; j = After(i, j)) {
        x[j] -= factor_[i][j] * scaled;
      }
    }
    for (int i = kTexelParameters - 1; i >= 0; --i) {
      for (int j = After(i, i); j < kTexelParameters; j = After(i, j)) {
        x[i] -= factor_[i][j] * x[j];
      }
      x[i] *= inverse_[i];
    }
  }

 private:
  // The column after j that row k has in common with: its channel's other albedo, then what is not
  // an albedo.
  static constexpr int After(int k, int j) {
    if (j >= kRough) return j + 1;
    return k == j && k % 2 == 0 ? j + 1 : static_cast<int>(kRough);
  }

  double factor_[kTexelParameters][kTexelParameters];
  double inverse_[kTexelParameters];
};

}  // namespace glint
