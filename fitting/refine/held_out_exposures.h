// How bright the light was in photographs that were not fitted, by the maps of those that were.
//
// Where every photograph has a lamp of its own, nothing else tells how strong it was. A photograph
// that is held out so takes part in finding its own exposure, and never in the maps.
#pragma once

#include <vector>

#include "fitting/refine/sample_source.h"

namespace glint {

// Factors on the exposures of the source's photographs: the median over texels and channels of
// photograph / rendering of the source's maps, texels left out that are clipped, masked or nearly
// black. 1 where none is left. The result does not depend on the number of threads.
std::vector<double> HeldOutExposures(SampleSource* source, int threads);

}  // namespace glint
