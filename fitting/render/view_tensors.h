// A batch's views as tensors, for renderers and features in plain torch operations on any device.
// Include from .cc files only: this header pulls in torch.
#pragma once

#include <torch/torch.h>

#include "fitting/render/render_autograd.h"

namespace glint {

// Numbers of every view, as in View: [B, V, 3, 1, 1], the exposure [B, V, 1, 1, 1].
struct ViewTensors {
  torch::Tensor light, camera, light_rgb, ambient_rgb, exposure;
};

// All of them in one copy to the device, for which the host does not wait (layers/staging.h).
ViewTensors TensorsOf(const ViewBatch& batch, const torch::TensorOptions& options);

struct ViewDirections {
  torch::Tensor light, camera, half;     // unit, from the texel, [B, V, 3, H, W]
  torch::Tensor light_distance_squared;  // mm², [B, V, 1, H, W]
};

ViewDirections DirectionsOf(const ViewTensors& views, const SamplePlane& plane);

}  // namespace glint
