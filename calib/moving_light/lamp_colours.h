// Of what colour the light was in each photograph of a camera that stood still.
//
// A highlight has the light's own colour, so that a coloured sample is whiter where its gloss
// shows: a lamp near the mirror direction seems to have another colour. Log ratios of red and of
// blue to green, of lamp v, point p and channel c, are
//
//   r_vpc = a_vc + log((e^ρ_pc + g_vp) / (1 + g_vp)) + e,   g_vp = e^t_v / b_p
//
// with a the lamps' (N(0, .1²)), ρ the points', b their albedos by the sample's, and g what gloss
// adds to green's diffuse: the dichromatic model (Shafer, "Using color to separate reflection
// components", 1985). t is a Gaussian process over the directions of light: gloss changes smoothly
// with them, lamps need not. Points of several colours tell a from t; where a sample has one
// colour, these priors do.
#pragma once

#include <vector>

#include "calib/moving_light/lamp_problem.h"

namespace glint {

// Logarithms of red/green and blue/green by those of the mean lamp.
struct LampColour {
  double red = 0, blue = 0;
};

// By lamp. `log_albedo`: of the points, but for a common term; not finite where none is known. The
// same for any number of threads.
std::vector<LampColour> EstimateLampColours(const LampProblem& problem,
                                            const std::vector<double>& log_albedo, int threads);

}  // namespace glint
