// Standard deviations of a texel's values from the normal equations at its solution.
#pragma once

#include <array>

#include "fitting/refine/refine.h"
#include "fitting/texel/texel_batch.h"

namespace glint {

// What must be known of a texel's covariance, by the physical values: the variances, and the
// covariance of the slopes.
struct TexelCovariance {
  std::array<double, kTexelParameters> variances{};
  double slopes = 0;

  void operator+=(const TexelCovariance& other);
};

// Of Laplace's approximation to the posterior: scale² times the inverse of the normal equations at
// the solution, prior included. `scale`: standard deviation of a residual of weight 1
// (residual_model.h).
TexelCovariance PosteriorCovariance(const BatchInverse& inverse, int lane, double scale);

// Of errors that all texels have in common, at this one.
TexelCovariance SystematicCovariance(const SystematicDeviations& deviations,
                                     const TexelValues& texel);

// Square roots. The cost's place holds half of `squares`, the photographs' weighted squared
// residuals.
std::array<float, kConfidencePlanes> TexelConfidence(const TexelCovariance& covariance,
                                                     const TexelValues& texel, double squares);

// What is added to the normal equations: of what nothing is known the widest deviation is kept; it
// stands in for a missing prior.
double LeastInformation(double scale);

}  // namespace glint
