// The fused CPU renderer as functions of torch's autograd.
//
// maps is [B, 10, H, W], contiguous float32 on the CPU, planes as in SvbrdfPlane (linear; unit
// normals). RenderBatch and LogLossBetweenMaps take maps on a GPU too and render them by
// render_reference.h there. Each batch element has its own V views: ViewBatch::views is [B][V],
// row-major. Gradients with respect to the normal take its components as free variables: normalise
// before. Work is shared among torch's intra-op threads; results do not depend on their number.
// Wrong shapes, types or devices throw c10::Error (TORCH_CHECK) that names the argument.
#pragma once

#include <vector>

#include "base/reflectance/convention.h"
#include "base/reflectance/view.h"

namespace at {
class Tensor;
}

namespace glint {

// How every element of a batch is seen; all have the same plane and number of views.
struct ViewBatch {
  SamplePlane plane;  // width and height must be the maps'
  ReflectanceConvention convention;
  int views_per_element = 0;
  std::vector<View> views;  // [B][V]
};

struct TensorLossOptions {
  bool clamp_rendered = false;  // to [0, 1]: the images are low dynamic range
  double offset = 0.01;         // inside the logarithms; > 0
};

// Renderings [B, V, 3, H, W]; differentiable with respect to maps.
at::Tensor RenderBatch(const at::Tensor& maps, const ViewBatch& batch);

// The loss of eq. 2 against images [B, V, 3, H, W], a scalar, without a rendering in memory. masks
// is [B, V, H, W], or undefined: all 1. light_rgb is [B, V, 3] and replaces the views' light_rgb,
// or undefined: the views' own. Differentiable with respect to maps and light_rgb.
at::Tensor LogLossBatch(const at::Tensor& maps, const at::Tensor& images, const at::Tensor& masks,
                        const at::Tensor& light_rgb, const ViewBatch& batch,
                        const TensorLossOptions& options);

// The same loss between renderings of two sets of maps, neither of them in memory: what training
// needs. Differentiable with respect to maps only.
at::Tensor LogLossBetweenMaps(const at::Tensor& maps, const at::Tensor& target_maps,
                              const ViewBatch& batch, const TensorLossOptions& options);

}  // namespace glint
