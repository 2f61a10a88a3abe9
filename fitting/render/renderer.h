// Renders SVBRDF maps as views see them: the plane z = 0 of texels under a camera and a near point
// light, and the adjoint of that. Needs nothing but the standard library; fused, vectorised CPU
// code chosen at run time (AVX-512, AVX2 or baseline). The model is in base/reflectance/brdf.h.
//
// Images are planar: three planes (R, G, B) of height×width, rows as in the maps (row 0 at +y),
// linear. Convention: `plane.sampling` says where the texels lie, `convention` gives the diffuse
// weight and the light's falloff. The maps' size must be the plane's; else std::invalid_argument.
//
// Results are the same bits for any number of threads (≤ 0: one per core).
#pragma once

#include <span>

#include "base/reflectance/convention.h"
#include "base/reflectance/svbrdf_maps.h"
#include "base/reflectance/view.h"

namespace glint {

// Radiance of every texel in one view; rgb_planar holds 3·height·width values.
void RenderView(const SvbrdfMaps& maps, const SamplePlane& plane, const View& view,
                const ReflectanceConvention& convention, float* rgb_planar, int threads = 1);

// The same for maps in memory of someone else's: kSvbrdfPlanes planes of the plane's size, one
// after the other. std::invalid_argument unless there are as many values.
void RenderView(std::span<const float> map_planes, const SamplePlane& plane, const View& view,
                const ReflectanceConvention& convention, float* rgb_planar, int threads = 1);

// A view and an image that belongs to it.
struct ViewImage {
  View view;
  const float* rgb_planar = nullptr;
};

// The adjoint of RenderView summed over views: given images of ∂loss/∂radiance, returns ∂loss/∂maps
// in the maps' planes. One pass over the texels; memory does not grow with the number of views.
SvbrdfMaps AdjointOfViews(const SvbrdfMaps& maps, const SamplePlane& plane,
                          std::span<const ViewImage> radiance_gradients,
                          const ReflectanceConvention& convention, int threads = 1);

// The same in memory of someone else's; `gradient_planes`, as large as `map_planes`, is
// overwritten.
void AdjointOfViews(std::span<const float> map_planes, const SamplePlane& plane,
                    std::span<const ViewImage> radiance_gradients,
                    const ReflectanceConvention& convention, std::span<float> gradient_planes,
                    int threads = 1);

}  // namespace glint
