// One texel's observations out of the photographs.
#pragma once

#include "fitting/refine/refine.h"
#include "fitting/texel/texel_observations.h"

namespace glint {

// Replaces what `observations` holds by the usable views of the texel.
void GatherObservations(const RefineProblem& problem, size_t texel,
                        TexelObservations* observations);

}  // namespace glint
