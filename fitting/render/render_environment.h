// What maps reflect of environment lighting.
#pragma once

#include "base/reflectance/convention.h"
#include "base/reflectance/environment_lighting.h"
#include "base/reflectance/svbrdf_maps.h"
#include "base/reflectance/view.h"

namespace glint {

// Adds what every texel reflects of `environment` toward the view's camera, times its exposure, to
// `rgb_planar` (3·height·width values, as RenderView() gives). Any number of threads gives the same
// bits. Throws std::invalid_argument unless the maps' size is the plane's.
void AddEnvironmentLighting(const EnvironmentLighting& environment, const SvbrdfMaps& maps,
                            const SamplePlane& plane, const View& view,
                            const ReflectanceConvention& convention, float* rgb_planar,
                            int threads = 1);

}  // namespace glint
