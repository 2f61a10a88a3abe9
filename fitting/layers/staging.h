// Numbers that the host draws, as tensors on any device. Include from .cc files only: pulls in
// torch.
#pragma once

#include <torch/torch.h>

#include <span>

namespace glint {

// `values` in the shape, type and on the device of `options`. To a GPU they go through pinned
// memory and in the order of its work, so that the host does not wait for what runs there.
torch::Tensor Staged(std::span<const double> values, at::IntArrayRef shape,
                     const torch::TensorOptions& options);

}  // namespace glint
