#include "fitting/render/renderer.h"

#include <algorithm>
#include <stdexcept>
#include <string>
#include <vector>

#include "fitting/render/batch.h"
#include "fitting/render/check_sizes.h"

namespace glint {
namespace {

void CheckPlanes(size_t values, const SamplePlane& plane) {
  const size_t wanted = static_cast<size_t>(kSvbrdfPlanes) *
                        static_cast<size_t>(std::max(plane.width, 0)) *
                        static_cast<size_t>(std::max(plane.height, 0));
  if (wanted > 0 && values == wanted) return;
  throw std::invalid_argument(
      "rendering: maps of " + std::to_string(plane.width) + "x" + std::to_string(plane.height) +
      " texels hold " + std::to_string(values) + " values instead of " + std::to_string(wanted));
}

}  // namespace

void RenderView(std::span<const float> map_planes, const SamplePlane& plane, const View& view,
                const ReflectanceConvention& convention, float* rgb_planar, int threads) {
  CheckPlanes(map_planes.size(), plane);
  if (rgb_planar == nullptr) throw std::invalid_argument("rendering: no memory for the image");
  const kernel::Grid<float> grid(plane);
  kernel::View<float> kernel_view = kernel::MakeView<float>(view);
  kernel_view.rendered = rgb_planar;
  kernel::Job<float> job = kernel::MakeJob<float>(grid, convention, {&kernel_view, 1});
  job.planes = map_planes.data();
  kernel::RunJobs<float>({&job, 1}, kernel::Mode::kRender, kernel::ThreadRunner(threads));
}

void RenderView(const SvbrdfMaps& maps, const SamplePlane& plane, const View& view,
                const ReflectanceConvention& convention, float* rgb_planar, int threads) {
  kernel::CheckSizes(maps, plane);
  RenderView(std::span<const float>(maps.planes), plane, view, convention, rgb_planar, threads);
}

void AdjointOfViews(std::span<const float> map_planes, const SamplePlane& plane,
                    std::span<const ViewImage> radiance_gradients,
                    const ReflectanceConvention& convention, std::span<float> gradient_planes,
                    int threads) {
  CheckPlanes(map_planes.size(), plane);
  CheckPlanes(gradient_planes.size(), plane);
  std::vector<kernel::View<float>> views;
  for (const ViewImage& image : radiance_gradients) {
    if (image.rgb_planar == nullptr) throw std::invalid_argument("rendering: a view has no image");
    views.push_back(kernel::MakeView<float>(image.view));
    views.back().image = image.rgb_planar;
  }
  const kernel::Grid<float> grid(plane);
  kernel::Job<float> job = kernel::MakeJob<float>(grid, convention, views);
  job.planes = map_planes.data();
  job.gradient = gradient_planes.data();
  kernel::RunJobs<float>({&job, 1}, kernel::Mode::kAdjoint, kernel::ThreadRunner(threads));
}

SvbrdfMaps AdjointOfViews(const SvbrdfMaps& maps, const SamplePlane& plane,
                          std::span<const ViewImage> radiance_gradients,
                          const ReflectanceConvention& convention, int threads) {
  kernel::CheckSizes(maps, plane);
  SvbrdfMaps gradient(maps.width, maps.height);
  AdjointOfViews(std::span<const float>(maps.planes), plane, radiance_gradients, convention,
                 gradient.planes, threads);
  return gradient;
}

}  // namespace glint
