// The encoding as functions of torch's autograd. Include from .cc files only.
#pragma once

#include <torch/torch.h>

namespace glint {

// Encoded maps [B, 9, H, W], float32 → SVBRDF maps [B, 10, H, W], planes as in SvbrdfPlane. The fused
// code of encoding.h both ways.
torch::Tensor DecodeTexelsTorch(const torch::Tensor& encoded);

// The same in torch operations, for any floating type; tests hold the two together.
torch::Tensor DecodeTexelsReference(const torch::Tensor& encoded);

}  // namespace glint
