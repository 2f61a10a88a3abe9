// Texels of a relief that another part of it hides from a low light.
//
// Where a texel is matte, the photographs tell: it shows y_v = I_v/E_v = b·l_v, with b its albedo
// times its normal (Woodham 1980). b is solved for each texel, from the high half of the lights
// first, then from all, with Cauchy's weights and the scale s of the texel's own residuals: gloss
// and shadows are outliers. The texel lies in shadow under light v with the odds
//
//   π_v N₊(q; 0, 0.2²) / ((1 − π_v) Cauchy(q − 1; s)),   q = y_v / b·l_v,
//
// where indirect light leaves some of what it would receive. Metals and other gloss have a large s,
// and q hardly tells: there π_v decides, which is how probable it is that the relief stands before
// the light, by the heights of the initial maps (Horizon) or by what is too fine for those: how
// often a Gaussian surface hides a light that is so low (Smith, "Geometrical shadowing of a random
// rough surface", IEEE Trans. Antennas Propag. 1967). A level sample casts none, whatever is dark.
// A slope that is turned away from the light hides itself and leaves, too: it would say no more
// than the heights do.
#pragma once

#include "fitting/photographs/photographs.h"
#include "fitting/relief/horizon.h"

namespace glint {

inline constexpr size_t kFewestForShadows = 8;  // photographs that tell a shadow from relief

// Standard deviation of a slope along one axis over the sample's texels, from at most 16,384 of
// them; 0 where they have fewer than eight photographs. Of photographs of all rows.
double ReliefSlopeSd(const PhotographSet& set, int threads);

// What hides a place from a light.
struct HidingRelief {
  Horizon horizon;
  double finer_slope_sd = 0;  // of slopes along one axis that its heights do not have
};

// Takes texels in shadow out of the photographs' masks. Each texel by itself: rows may be some of
// the sample's. Fewer than eight photographs stay as they are.
void MaskCastShadows(const HidingRelief& relief, int threads, PhotographSet* set);

// How often a Gaussian surface hides a light whose elevation has this tangent.
double ShadowedShare(double elevation_tangent, double relief_slope_sd);

}  // namespace glint
