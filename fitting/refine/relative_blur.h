// How much more than the others photographs are blurred, where nobody measured it.
//
// A Gaussian of the variance V, texels², takes the share 1 − exp(−4π²Vf²) of a detail's power at
// the frequency f, cycles per texel. So with P_v the power of a photograph's log radiance and M the
// median over photographs,
//   log P_v(f) − log M(f) ≈ c_v − 4π² V_v f²,
// fitted over rings of f from 0.06 to 0.42: c_v is the contrast that its light gives the sample.
// Rings below hold shading, those above mostly noise and JPEG.
#pragma once

#include <vector>

#include "fitting/photographs/photographs.h"

namespace glint {

// V by photograph, more than the mean of the sharper half; 0 where it is less than light by itself
// changes detail (kLeastRelativeBlur), and of all where fewer than three, or too small to tell.
std::vector<double> RelativeBlurs(const PhotographSet& set, int threads);

}  // namespace glint
