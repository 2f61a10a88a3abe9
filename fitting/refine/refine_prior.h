// How strongly a texel is held to its start: from the noise in the photographs, the error expected
// of the start, and how much the views tell.
#pragma once

#include "fitting/refine/refine.h"
#include "fitting/refine/texel_prior.h"

namespace glint {

// Standard deviations expected of a start's error.
struct StartErrors {
  double normal = 0.10;  // of n_x, n_y
  double roughness = 0.10;
  double diffuse = 0.05;
  double specular = 0.05;
};

// Number of views that tell something of their own: n² / Σ_ij exp(−θ_ij²/2τ²) with θ_ij the angle
// between half vectors of views i and j at the sample's centre, τ = 8°. n views from one place count
// as one; views spread over the hemisphere count fully.
double DistinctViews(const RefineProblem& problem);

// Square roots of weights (sigma / start error)²: a start with such errors is one more observation,
// in units of the residuals' noise.
PriorWeights BelieveStart(double residual_sigma, const StartErrors& errors);

// The same times factor·15/distinct². From one photograph the hold has to be far stronger than
// belief: its three numbers are exact, and nine unknowns explain them in many wrong ways, which
// least squares takes for knowledge. Best factors measured on procedural materials, 8 bit: 10–30 with
// one view, 10 with two, 3 with five, 1–3 with twenty, relative to 1/distinct.
PriorWeights HoldToStart(double factor, double residual_sigma, double distinct_views,
                         const StartErrors& errors);

}  // namespace glint
