// Photographs of encoded maps for the estimator's training. Include from .cc files only: pulls in
// torch.
#pragma once

#include <torch/torch.h>

#include "fitting/training/random.h"

namespace glint {

struct PhotographBatch {
  torch::Tensor features;  // [B, 11, S, S]
  torch::Tensor profiles;  // [B, 72]
};

// One photograph of each of the maps [B, 9, S, S], drawn from `random` (estimator_trainer.h).
// `plain`: from the top, rightly exposed, 8 bits; for validation.
PhotographBatch PhotographMaps(const torch::Tensor& encoded, Stream* random, bool plain);

}  // namespace glint
