// Learned descent: an estimate improved by looking at how it explains the photographs. Include from
// .cc files only: this header pulls in torch.
//
// Each step renders the present maps under every photograph's light and camera, takes the gradient
// of the photographs' likelihood with respect to the encoded maps, and lets a small network, the
// same for all steps, turn gradient, residuals and maps into a change of maps and errors (Adler and
// Öktem 2017, "Solving ill-posed inverse problems using iterative deep neural networks"). All that
// the renderer needs is in the features: directions, and what a matte, flat texel would reflect.
#pragma once

#include <torch/torch.h>

#include <cstdint>
#include <vector>

#include "fitting/weights/tensor_records.h"

namespace glint {

inline constexpr int kDescentSteps = 3;

// What an estimate's maps leave unexplained, of all photographs of a sample.
struct Unexplained {
  torch::Tensor gradient;  // [B, 9, H, W], of the mean loss over photographs by encoded maps
  torch::Tensor residual;  // [B, 3, H, W], mean of observed − rendered, of the features' roots
  torch::Tensor size;      // [B, 3, H, W], mean of its absolute value
};

// Of encoded maps [B, 9, H, W] under the photographs of `features` [B, N, 11, H, W]. A clipped
// texel explains whatever is brighter. No gradient flows through it.
Unexplained UnexplainedBy(const torch::Tensor& maps, const torch::Tensor& features);

struct DescentNetwork {
  std::vector<torch::Tensor> weights, biases;  // 3×3 convolutions

  static DescentNetwork Random(std::uint64_t seed);
  NamedTensors State();

  // `maps` and `log_scale` [B, 9, H, W] after kDescentSteps steps.
  void Improve(const torch::Tensor& features, torch::Dtype compute, torch::Tensor* maps,
               torch::Tensor* log_scale) const;
};

}  // namespace glint
