// What refine's manifest says of a result under "metrics", beside its views and corrections.
#pragma once

#include <span>

#include "base/formats/manifest_fields.h"
#include "fitting/refine/refine.h"

namespace glint {

// Of its texels.
std::span<const ManifestField<RefineSummary>> TexelMetrics();
// Of what was estimated of the sample as a whole.
std::span<const ManifestField<RefineSummary>> SampleMetrics();

// null: one lobe.
Json JsonOf(const SpecularLobes& lobes);
// `ratio` and `direction_deg`; null where isotropic.
Json JsonOf(const Anisotropy& anisotropy);

}  // namespace glint
