// Texels' observations out of the photographs.
#pragma once

#include <span>

#include "fitting/refine/refine.h"
#include "fitting/texel/texel_batch.h"

namespace glint {

// Replaces what `observations` holds by those of at most a batch of texels, each in its lane. The
// room lights them as if they were as `maps` say (it changes slowly with the normal, and is faint).
// `views`: those to take, by their place in `problem`.
void GatherObservations(const RefineProblem& problem, const SvbrdfMaps& maps,
                        std::span<const size_t> texels, std::span<const int> views,
                        BatchObservations* observations);

}  // namespace glint
