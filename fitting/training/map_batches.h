// Batches of encoded maps as tensors. Include from .cc files only: this header pulls in torch.
#pragma once

#include <torch/torch.h>

#include <functional>
#include <future>

#include "fitting/training/train_options.h"

namespace glint {

struct BatchShape {
  int count = 0, crop = 0;
};

// Of step `step`: one of the options' crops, and as many as have the texels of a whole batch.
BatchShape BatchShapeOf(const TrainOptions& options, std::int64_t step);

// The pool's crops of a training, [count, 9, crop, crop] on the training's device. The next step's
// are cut while this one's are used.
class MapBatches {
 public:
  using ShapeOf = std::function<BatchShape(std::int64_t step)>;
  // `shape_of` depends on the step alone; empty: BatchShapeOf().
  MapBatches(const TrainOptions& options, const MaterialSource& materials, std::int64_t first_step,
             ShapeOf shape_of = {});
  ~MapBatches();

  torch::Tensor Sample(std::int64_t step);
  torch::Tensor SampleFirst(int count, int crop);

 private:
  torch::Tensor Cut(std::int64_t step);

  const torch::Device device_;
  const ShapeOf shape_of_;
  MaterialPool pool_;
  std::int64_t next_step_ = -1;
  std::future<torch::Tensor> next_;
};

// The first sixteen materials of a source, encoded: [16, 9, size, size].
torch::Tensor ValidationMaps(const MaterialSource& source, int size);

}  // namespace glint
