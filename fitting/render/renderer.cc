#include "fitting/render/renderer.h"

#include <stdexcept>
#include <vector>

#include "fitting/render/batch.h"
#include "fitting/render/check_sizes.h"

namespace glint {

void RenderView(const SvbrdfMaps& maps, const SamplePlane& plane, const View& view,
                const ReflectanceConvention& convention, float* rgb_planar, int threads) {
  kernel::CheckSizes(maps, plane);
  if (rgb_planar == nullptr) throw std::invalid_argument("rendering: no memory for the image");
  const kernel::Grid<float> grid(plane);
  kernel::View<float> kernel_view = kernel::MakeView<float>(view);
  kernel_view.rendered = rgb_planar;
  kernel::Job<float> job = kernel::MakeJob<float>(grid, convention, {&kernel_view, 1});
  job.planes = maps.planes.data();
  kernel::RunJobs<float>({&job, 1}, kernel::Mode::kRender, kernel::ThreadRunner(threads));
}

SvbrdfMaps AdjointOfViews(const SvbrdfMaps& maps, const SamplePlane& plane,
                          std::span<const ViewImage> radiance_gradients,
                          const ReflectanceConvention& convention, int threads) {
  kernel::CheckSizes(maps, plane);
  std::vector<kernel::View<float>> views;
  for (const ViewImage& image : radiance_gradients) {
    if (image.rgb_planar == nullptr) throw std::invalid_argument("rendering: a view has no image");
    views.push_back(kernel::MakeView<float>(image.view));
    views.back().image = image.rgb_planar;
  }
  SvbrdfMaps gradient(maps.width, maps.height);
  const kernel::Grid<float> grid(plane);
  kernel::Job<float> job = kernel::MakeJob<float>(grid, convention, views);
  job.planes = maps.planes.data();
  job.gradient = gradient.planes.data();
  kernel::RunJobs<float>({&job, 1}, kernel::Mode::kAdjoint, kernel::ThreadRunner(threads));
  return gradient;
}

}  // namespace glint
