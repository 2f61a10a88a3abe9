// Standard deviations of a texel's values from the normal equations at its solution.
#pragma once

#include <array>

#include "fitting/refine/refine.h"
#include "fitting/texel/texel_kernel.h"

namespace glint {

// By the physical values, row-major.
using TexelCovariance = std::array<double, kTexelParameters * kTexelParameters>;

// √diag(scale²·M⁻¹ + common) with M = `gram` by the physical values, prior included: the covariance
// of Laplace's approximation to the posterior, and what it takes as certain is uncertain by (see
// SampleModel::CommonCovariance). `scale`: standard deviation of a residual of weight 1
// (residual_model.h). The cost's place holds half of `squares`, the photographs' weighted squared
// residuals.
std::array<float, kConfidencePlanes> TexelConfidence(const TexelGram& gram,
                                                     const TexelValues& texel, double squares,
                                                     double scale, const TexelCovariance& common);

}  // namespace glint
