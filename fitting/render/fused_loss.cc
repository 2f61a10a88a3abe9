#include "fitting/render/fused_loss.h"

#include <stdexcept>
#include <string>

#include "base/reflectance/brdf_constants.h"
#include "fitting/render/batch.h"
#include "fitting/render/check_sizes.h"

namespace glint {
namespace {

std::vector<kernel::View<float>> KernelViews(std::span<const ViewImages> images) {
  std::vector<kernel::View<float>> views;
  views.reserve(images.size());
  for (const ViewImages& image : images) {
    if (image.rgb_linear_planar == nullptr) {
      throw std::invalid_argument("fitting loss: view " + std::to_string(views.size()) +
                                  " has no photograph");
    }
    views.push_back(kernel::MakeView<float>(image.view));
    views.back().image = image.rgb_linear_planar;
    views.back().mask = image.mask;
  }
  return views;
}

// Scales the kernel's sums to means.
void Summarise(std::span<const kernel::ViewSums> sums, std::span<const ViewImages> images,
               LossAndGradient* result) {
  double loss = 0, weight = 0;
  for (const kernel::ViewSums& view : sums) {
    loss += view.loss();
    weight += view.weight();
    result->view_weights.push_back(view.weight());
    result->view_losses.push_back(view.weight() > 0 ? view.loss() / (3 * view.weight()) : 0.0);
  }
  if (!(weight > 0)) {
    throw std::invalid_argument(
        "fitting loss: no usable texel in any view (every mask is 0); check masks and exposures");
  }
  const double scale = 1 / (3 * weight);
  result->loss = loss * scale;
  const float gradient_scale = static_cast<float>(scale);
  for (float& value : result->gradient.planes) value *= gradient_scale;
  if (result->gradient.planes.empty()) return;
  for (size_t v = 0; v < sums.size(); ++v) {
    const double by_exposed = scale * images[v].view.exposure;
    Vec3d light, ambient;
    for (int c = 0; c < 3; ++c) {
      light[c] = sums[v].light(c) * by_exposed;
      ambient[c] = sums[v].ambient(c) * by_exposed;
    }
    result->light_gradients.push_back(light);
    result->ambient_gradients.push_back(ambient);
  }
}

}  // namespace

LossAndGradient EvaluateLogLoss(const SvbrdfMaps& maps, const SamplePlane& plane,
                                std::span<const ViewImages> images,
                                const ReflectanceConvention& convention,
                                const LogLossOptions& options) {
  kernel::CheckSizes(maps, plane);
  if (!(options.offset > 0)) {
    throw std::invalid_argument("fitting loss: offset is " + std::to_string(options.offset) +
                                "; it must be above 0");
  }
  const kernel::Grid<float> grid(plane);
  const std::vector<kernel::View<float>> views = KernelViews(images);
  kernel::Job<float> job = kernel::MakeJob<float>(grid, convention, views);
  job.planes = maps.planes.data();
  job.clamp_rendered = options.clamp_rendered;
  job.log_offset = static_cast<float>(options.offset);
  LossAndGradient result;
  if (options.want_gradient) {
    result.gradient = SvbrdfMaps(maps.width, maps.height);
    job.gradient = result.gradient.planes.data();
  }
  const auto mode = options.want_gradient ? kernel::Mode::kLossGradient : kernel::Mode::kLoss;
  const std::vector<kernel::ViewSums> sums =
      kernel::RunJobs<float>({&job, 1}, mode, kernel::ThreadRunner(options.threads));
  Summarise(sums, images, &result);
  return result;
}

}  // namespace glint
