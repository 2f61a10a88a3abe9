// One texel's observations out of the photographs.
#pragma once

#include "fitting/refine/refine.h"
#include "fitting/refine/texel_observations.h"

namespace glint {

// Linear radiance from which an 8-bit photograph is taken to be at its limit: half a step of gamma
// 2.2 below 1.
inline constexpr double kClipped = 0.9956;

// Replaces what `observations` holds by the usable views of the texel.
void GatherObservations(const RefineProblem& problem, size_t texel,
                        TexelObservations* observations);

}  // namespace glint
