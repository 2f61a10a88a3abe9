// The albedos of one texel in closed form, its normal and roughness given.
#pragma once

#include "base/reflectance/convention.h"
#include "fitting/texel/texel_parameters.h"

namespace glint {

// Sums over the views of one channel, in which the photograph is C + k_d·A + k_s·B, all relative to
// it: products of A, B and what C leaves of the photograph (batch_kernel.h).
struct AlbedoSums {
  double aa, ab, bb, ay, by, yy;
};

// Albedos that fit the texel best with its normal and roughness as they are: per channel a 2×2
// least squares of I + 0.01 relative to itself (the logarithm to first order), with a prior
// toward the albedos of `toward` (`prior_weights`: of squared differences, in the parameters'
// order), and kept in [0, 1]. Clipped observations do not take part.
struct AlbedoFit {
  double before = 0;  // sum of squared (relative) residuals with the albedos given …
  double after = 0;   // … and with those found
};
AlbedoFit FitAlbedos(const AlbedoSums sums[3], DiffuseWeight diffuse_weight,
                     const double prior_weights[6], const TexelValues& toward, TexelValues* texel);

}  // namespace glint
