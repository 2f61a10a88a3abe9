// Batches of encoded maps as tensors. Include from .cc files only: this header pulls in torch.
#pragma once

#include <torch/torch.h>

#include "fitting/training/train_options.h"

namespace glint {

// The pool's crops of a training, [count, 9, crop, crop].
class MapBatches {
 public:
  MapBatches(const TrainOptions& options, const MaterialSource& materials, std::int64_t first_step);

  torch::Tensor Sample(std::int64_t step);
  torch::Tensor SampleFirst(int count);

 private:
  int batch_, crop_;
  MaterialPool pool_;
};

// The first sixteen materials of a source, encoded: [16, 9, size, size].
torch::Tensor ValidationMaps(const MaterialSource& source, int size);

}  // namespace glint
