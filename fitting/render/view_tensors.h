// A batch's views as tensors, for renderers and features in plain torch operations on any device.
// Include from .cc files only: this header pulls in torch.
#pragma once

#include <torch/torch.h>

#include "fitting/render/render_autograd.h"

namespace glint {

// A vector of every view, [B, V, 3, 1, 1].
torch::Tensor PerView(const ViewBatch& batch, Vec3d View::*member,
                      const torch::TensorOptions& options);

torch::Tensor ExposuresOf(const ViewBatch& batch, const torch::TensorOptions& options);  // …, 1, 1

struct ViewDirections {
  torch::Tensor light, camera, half;     // unit, from the texel, [B, V, 3, H, W]
  torch::Tensor light_distance_squared;  // mm², [B, V, 1, H, W]
};

ViewDirections DirectionsOf(const ViewBatch& batch, const torch::TensorOptions& options);

}  // namespace glint
