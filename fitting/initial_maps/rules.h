// A first estimate of the maps from the photographs alone, by heuristics: where fitting starts.
//
//   1. One pair of lobes for the whole sample (lobes.h): roughness, specular and mean diffuse.
//   2. Per texel, the brightness relative to what those lobes predict, median over the photographs,
//      scales the diffuse albedo (and the specular one where the sample looks metallic).
//   3. With four or more photographs, normals by photometric stereo on those in which the texel's
//      highlight is weak; flat otherwise.
// Source of the need: Gao et al. 2019, section 4.3: latent fitting from a random code fails.
#pragma once

#include "base/reflectance/svbrdf_maps.h"
#include "fitting/initial_maps/lobes.h"
#include "fitting/photographs/photographs.h"

namespace glint {

// Maps of the set's size. `set.Check()` must be empty. Results do not depend on `threads`.
SvbrdfMaps EstimateMaps(const PhotographSet& set, int threads);

}  // namespace glint
