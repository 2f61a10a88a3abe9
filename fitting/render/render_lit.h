// Renderings under lights that do not shine alike in all directions.
#pragma once

#include "base/reflectance/convention.h"
#include "base/reflectance/svbrdf_maps.h"
#include "base/reflectance/view.h"

namespace glint {

// As RenderView(), with View::beam. Any number of threads gives the same bits. Throws
// std::invalid_argument unless the maps' size is the plane's.
void RenderLit(const SvbrdfMaps& maps, const SamplePlane& plane, const View& view,
               const ReflectanceConvention& convention, float* rgb_planar, int threads = 1);

}  // namespace glint
