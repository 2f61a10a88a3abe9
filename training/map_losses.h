// Losses between encoded maps that all trainings use. Include from .cc files only: pulls in torch.
#pragma once

#include <torch/torch.h>

#include "training/train_options.h"

namespace glint {

// What an L1 error of each encoded channel counts, [1, 9, 1, 1], mean 1.
torch::Tensor MapWeights(const TrainOptions& options);

// mean |log R(truth) − log R(decoded)| over `options.render_views` renderings of each crop of
// [B, 9, S, S], drawn for `step` (render_loss.h).
torch::Tensor RenderLossOf(const torch::Tensor& decoded, const torch::Tensor& truth,
                           const TrainOptions& options, std::int64_t step);

}  // namespace glint
