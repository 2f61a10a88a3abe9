// Inside of glint_render: sizes that must agree before a kernel reads memory by them.
#pragma once

#include "base/reflectance/svbrdf_maps.h"
#include "base/reflectance/view.h"

namespace glint::kernel {

// Throws std::invalid_argument that says both sizes unless the maps are whole and of the plane's.
void CheckSizes(const SvbrdfMaps& maps, const SamplePlane& plane);

}  // namespace glint::kernel
