// Standard deviations of a texel's values from the normal equations at its solution.
#pragma once

#include <array>

#include "fitting/refine/refine.h"
#include "fitting/texel/texel_kernel.h"

namespace glint {

// √diag(s²·(JᵀJ)⁻¹) with `gram` by the physical values, belief in the start included
// (Gauss–Newton's covariance).
// The residual variance s² joins the texel's own residuals with `residual_sigma`, the photographs'
// common one, which counts as kCommonWeight residuals: a texel alone has too few to tell it. It is
// `shared_noise` times as large where channels share their errors (residual_noise.h).
// The cost's place holds half of `gram`'s squared residuals.
std::array<float, kConfidencePlanes> TexelConfidence(const TexelGram& gram,
                                                     const TexelValues& texel, int residuals,
                                                     double residual_sigma, double shared_noise);

inline constexpr double kCommonWeight = 12.0;

}  // namespace glint
