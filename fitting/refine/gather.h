// One texel's observations out of the photographs.
#pragma once

#include <span>

#include "fitting/refine/refine.h"
#include "fitting/texel/texel_observations.h"

namespace glint {

// Replaces what `observations` holds by the usable views of the texel. The room lights it as if it
// were as `maps` say (it changes slowly with the normal, and is faint). `views`: those to take, by
// their place in `problem`.
void GatherObservations(const RefineProblem& problem, const SvbrdfMaps& maps, size_t texel,
                        std::span<const int> views, TexelObservations* observations);

}  // namespace glint
