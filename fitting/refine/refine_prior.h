// How strongly a texel is held to its start: from the noise in the photographs, the error expected
// of the start, and how much the views tell.
#pragma once

#include "fitting/refine/refine.h"
#include "fitting/texel/texel_prior.h"

namespace glint {

// Number of views that tell something of their own: n² / Σ_ij exp(−θ_ij²/2τ²) with θ_ij the angle
// between half vectors of views i and j at the sample's centre, τ = 8°. n views from one place
// count as one; views spread over the hemisphere count fully.
double DistinctViews(const RefineProblem& problem);

// Residuals sigma·(departure / start error): a start with such errors is one more observation,
// in units of the residuals' noise.
PriorWeights BelieveStart(double residual_sigma, const StartErrors& errors);

// The same, its weight times factor·15/distinct^1.4. From one photograph the hold has to be far
// stronger than belief: its three numbers are exact, and nine unknowns explain them in many wrong
// ways, which least squares takes for knowledge. Measured on procedural materials in 8-bit views
// (docs/experiments.md); the hold also vanishes as sigma² does, against residuals that are seen.
PriorWeights HoldToStart(double factor, double residual_sigma, double distinct_views,
                         const StartErrors& errors);

}  // namespace glint
