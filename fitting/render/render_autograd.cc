#include "fitting/render/render_autograd.h"

#include <ATen/Parallel.h>
#include <torch/torch.h>

#include <memory>

#include "base/reflectance/svbrdf_maps.h"
#include "fitting/render/batch.h"
#include "fitting/render/render_reference.h"

namespace glint {
namespace {

using torch::Tensor;
using torch::autograd::AutogradContext;
using torch::autograd::variable_list;

// Tiles on torch's own intra-op threads: a second pool beside them would fight for the cores.
void RunOnTorchThreads(int tiles, const std::function<void(int)>& task) {
  at::parallel_for(0, tiles, 1, [&task](int64_t begin, int64_t end) {
    for (int64_t tile = begin; tile < end; ++tile) task(static_cast<int>(tile));
  });
}

void CheckTensor(const char* name, const Tensor& tensor, at::IntArrayRef shape) {
  TORCH_CHECK(tensor.defined(), name, ": undefined tensor");
  TORCH_CHECK(tensor.device().is_cpu() && tensor.scalar_type() == torch::kFloat32, name, ": found ",
              tensor.toString(), "; give float32 on the CPU");
  TORCH_CHECK(tensor.sizes() == shape, name, ": found shape ", tensor.sizes(), " instead of ",
              shape);
}

void CheckBatch(const Tensor& maps, const ViewBatch& batch) {
  TORCH_CHECK(maps.defined() && maps.dim() == 4, "maps: expected [B, 10, H, W]");
  CheckTensor("maps", maps, {maps.size(0), kSvbrdfPlanes, batch.plane.height, batch.plane.width});
  const int64_t expected = maps.size(0) * batch.views_per_element;
  TORCH_CHECK(static_cast<int64_t>(batch.views.size()) == expected, "views: found ",
              batch.views.size(), " instead of ", expected, " = batch size · views per element");
}

// Kernel jobs over a batch, with the memory they point into.
class BatchJobs {
 public:
  BatchJobs(const ViewBatch& batch, const Tensor& maps) : grid_(batch.plane) {
    const size_t elements = maps.size(0), per_element = batch.views_per_element;
    const size_t map_size = kSvbrdfPlanes * texels();
    for (const View& view : batch.views) views_.push_back(kernel::MakeView<float>(view));
    for (size_t b = 0; b < elements; ++b) {
      const std::span<const kernel::View<float>> views(views_.data() + b * per_element,
                                                       per_element);
      jobs_.push_back(kernel::MakeJob<float>(grid_, batch.convention, views));
      jobs_.back().planes = maps.data_ptr<float>() + b * map_size;
    }
  }

  size_t texels() const { return grid_.x_mm.size() * grid_.y_mm.size(); }
  std::vector<kernel::View<float>>& views() { return views_; }
  std::vector<kernel::Job<float>>& jobs() { return jobs_; }

  void SetImages(const float* images) {
    for (size_t v = 0; v < views_.size(); ++v) views_[v].image = images + v * 3 * texels();
  }

  void SetMasks(const float* masks) {
    for (size_t v = 0; v < views_.size(); ++v) views_[v].mask = masks + v * texels();
  }

  void SetLight(const ViewBatch& batch, const float* light_rgb) {
    for (size_t v = 0; v < views_.size(); ++v) {
      const float exposure = static_cast<float>(batch.views[v].exposure);
      for (int c = 0; c < 3; ++c) views_[v].exposed_light[c] = exposure * light_rgb[v * 3 + c];
    }
  }

  void SetTarget(const float* maps) {
    for (size_t b = 0; b < jobs_.size(); ++b) {
      jobs_[b].target_planes = maps + b * kSvbrdfPlanes * texels();
    }
  }

  // Memory for ∂/∂maps, which Run fills in the modes that have a gradient.
  Tensor SetGradientLike(const Tensor& maps) {
    Tensor gradient = torch::empty_like(maps);
    for (size_t b = 0; b < jobs_.size(); ++b) {
      jobs_[b].gradient = gradient.data_ptr<float>() + b * kSvbrdfPlanes * texels();
    }
    return gradient;
  }

  std::vector<kernel::ViewSums> Run(kernel::Mode mode) {
    return kernel::RunJobs<float>(jobs_, mode, RunOnTorchThreads);
  }

 private:
  kernel::Grid<float> grid_;
  std::vector<kernel::View<float>> views_;
  std::vector<kernel::Job<float>> jobs_;
};

struct BatchHolder : torch::CustomClassHolder {
  explicit BatchHolder(const ViewBatch& batch_in) : batch(batch_in) {}
  ViewBatch batch;
};
using BatchPointer = c10::intrusive_ptr<BatchHolder>;

class RenderFunction : public torch::autograd::Function<RenderFunction> {
 public:
  static Tensor forward(AutogradContext* context, const Tensor& maps, BatchPointer holder) {
    const ViewBatch& batch = holder->batch;
    BatchJobs jobs(batch, maps);
    Tensor images = torch::empty(
        {maps.size(0), batch.views_per_element, 3, batch.plane.height, batch.plane.width},
        maps.options());
    for (size_t v = 0; v < jobs.views().size(); ++v) {
      jobs.views()[v].rendered = images.data_ptr<float>() + v * 3 * jobs.texels();
    }
    jobs.Run(kernel::Mode::kRender);
    context->save_for_backward({maps});
    context->saved_data["batch"] = c10::IValue::make_capsule(std::move(holder));
    return images;
  }

  static variable_list backward(AutogradContext* context, variable_list gradients) {
    const Tensor maps = context->get_saved_variables()[0];
    const auto capsule = context->saved_data["batch"].toCapsule();
    BatchJobs jobs(static_cast<const BatchHolder&>(*capsule).batch, maps);
    const Tensor by_image = gradients[0].contiguous();
    jobs.SetImages(by_image.data_ptr<float>());
    Tensor gradient = jobs.SetGradientLike(maps);
    jobs.Run(kernel::Mode::kAdjoint);
    return {gradient, Tensor()};
  }
};

// Means from the kernel's sums: the loss, and ∂loss/∂light_rgb [B, V, 3].
struct BatchLoss {
  double loss = 0;
  double scale = 0;  // of a sum over channels, views and texels
  Tensor by_light;
};

BatchLoss Summarise(const std::vector<kernel::ViewSums>& sums, const ViewBatch& batch) {
  BatchLoss result;
  double weight = 0;
  for (const kernel::ViewSums& view : sums) {
    result.loss += view.loss();
    weight += view.weight();
  }
  TORCH_CHECK(weight > 0, "masks: no usable texel in any view (every mask is 0)");
  result.scale = 1 / (3 * weight);
  result.loss *= result.scale;
  result.by_light = torch::empty({static_cast<int64_t>(sums.size()), 3});
  float* by_light = result.by_light.data_ptr<float>();
  for (size_t v = 0; v < sums.size(); ++v) {
    const double scale = batch.views[v].exposure * result.scale;
    for (int c = 0; c < 3; ++c) by_light[v * 3 + c] = static_cast<float>(sums[v].light(c) * scale);
  }
  result.by_light = result.by_light.view({-1, batch.views_per_element, 3});
  return result;
}

// Autograd functions take no undefined tensors: an empty one stands for an absent argument.
bool Given(const Tensor& tensor) { return tensor.numel() > 0; }

// Forward computes the gradient too, in the same pass; backward only scales it.
class LogLossFunction : public torch::autograd::Function<LogLossFunction> {
 public:
  static Tensor forward(AutogradContext* context, const Tensor& maps, const Tensor& light_rgb,
                        const Tensor& images, const Tensor& masks, const Tensor& target_maps,
                        const ViewBatch& batch, const TensorLossOptions& options,
                        bool want_gradient) {
    BatchJobs jobs(batch, maps);
    if (Given(target_maps)) jobs.SetTarget(target_maps.data_ptr<float>());
    if (Given(images)) jobs.SetImages(images.data_ptr<float>());
    if (Given(masks)) jobs.SetMasks(masks.data_ptr<float>());
    if (Given(light_rgb)) jobs.SetLight(batch, light_rgb.data_ptr<float>());
    for (kernel::Job<float>& job : jobs.jobs()) {
      job.clamp_rendered = options.clamp_rendered;
      job.log_offset = static_cast<float>(options.offset);
    }
    Tensor gradient = want_gradient ? jobs.SetGradientLike(maps) : Tensor();
    const BatchLoss result = Summarise(
        jobs.Run(want_gradient ? kernel::Mode::kLossGradient : kernel::Mode::kLoss), batch);
    if (want_gradient) {
      context->save_for_backward({gradient, result.by_light});
      context->saved_data["scale"] = result.scale;
      context->saved_data["light"] = Given(light_rgb);
    }
    return torch::tensor(result.loss, maps.options());
  }

  static variable_list backward(AutogradContext* context, variable_list gradients) {
    const variable_list saved = context->get_saved_variables();
    const double scale = context->saved_data["scale"].toDouble();
    Tensor by_light;
    if (context->saved_data["light"].toBool()) by_light = saved[1] * gradients[0];
    return {saved[0] * (gradients[0] * scale),
            by_light,
            Tensor(),
            Tensor(),
            Tensor(),
            Tensor(),
            Tensor(),
            Tensor()};
  }
};

bool WantsGradient(const Tensor& tensor) {
  return tensor.defined() && tensor.requires_grad() && at::GradMode::is_enabled();
}

Tensor ContiguousOrEmpty(const Tensor& tensor) {
  return tensor.defined() ? tensor.contiguous() : torch::empty({0});
}

void CheckOptions(const TensorLossOptions& options) {
  TORCH_CHECK(options.offset > 0, "offset: found ", options.offset, "; it must be above 0");
}

}  // namespace

Tensor RenderBatch(const Tensor& maps, const ViewBatch& batch) {
  if (!maps.device().is_cpu()) return RenderReference(maps, Tensor(), batch);
  CheckBatch(maps, batch);
  return RenderFunction::apply(maps.contiguous(), c10::make_intrusive<BatchHolder>(batch));
}

Tensor LogLossBatch(const Tensor& maps, const Tensor& images, const Tensor& masks,
                    const Tensor& light_rgb, const ViewBatch& batch,
                    const TensorLossOptions& options) {
  CheckBatch(maps, batch);
  CheckOptions(options);
  const int64_t elements = maps.size(0), views = batch.views_per_element;
  const int64_t height = batch.plane.height, width = batch.plane.width;
  CheckTensor("images", images, {elements, views, 3, height, width});
  if (masks.defined()) CheckTensor("masks", masks, {elements, views, height, width});
  if (light_rgb.defined()) CheckTensor("light_rgb", light_rgb, {elements, views, 3});
  return LogLossFunction::apply(maps.contiguous(), ContiguousOrEmpty(light_rgb),
                                images.detach().contiguous(), ContiguousOrEmpty(masks),
                                torch::empty({0}), batch, options,
                                WantsGradient(maps) || WantsGradient(light_rgb));
}

Tensor LogLossBetweenMaps(const Tensor& maps, const Tensor& target_maps, const ViewBatch& batch,
                          const TensorLossOptions& options) {
  CheckOptions(options);
  if (!maps.device().is_cpu()) {
    return LogLossReference(RenderReference(maps, Tensor(), batch),
                            RenderReference(target_maps.detach(), Tensor(), batch), Tensor(),
                            options);
  }
  CheckBatch(maps, batch);
  CheckTensor("target_maps", target_maps, maps.sizes());
  return LogLossFunction::apply(maps.contiguous(), torch::empty({0}), torch::empty({0}),
                                torch::empty({0}), target_maps.detach().contiguous(), batch,
                                options, WantsGradient(maps));
}

}  // namespace glint
