// The encoding as functions of torch's autograd, and its tensors as maps. Include from .cc files
// only.
#pragma once

#include <torch/torch.h>

#include "fitting/encoding/encoding.h"

namespace glint {

// Encoded maps [B, 9, H, W], float32 → SVBRDF maps [B, 10, H, W], planes as in SvbrdfPlane. The
// fused code of encoding.h both ways.
torch::Tensor DecodeTexelsTorch(const torch::Tensor& encoded);

// The same in torch operations, for any floating type; tests hold the two together.
torch::Tensor DecodeTexelsReference(const torch::Tensor& encoded);

// The top left width × height texels of the first of encoded maps [B, 9, H, W], float32 on the CPU.
EncodedMaps CroppedMaps(const torch::Tensor& encoded, int width, int height);

}  // namespace glint
