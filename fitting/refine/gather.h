// One texel's observations out of the photographs.
#pragma once

#include "fitting/refine/refine.h"
#include "fitting/refine/texel_observations.h"

namespace glint {

// Linear radiance from which a photograph that clips is taken to be at its limit; resampling may
// have mixed a little of a darker pixel in (see AdmitClippedTexels).
inline constexpr double kClipped = 0.99;

// Replaces what `observations` holds by the usable views of the texel.
void GatherObservations(const RefineProblem& problem, size_t texel,
                        TexelObservations* observations);

}  // namespace glint
