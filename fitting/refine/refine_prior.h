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

// Square roots of weights: factor·(sigma / start error)², less where views tell more.
PriorWeights HoldToStart(double factor, double residual_sigma, double distinct_views,
                         const StartErrors& errors);

}  // namespace glint
