// Batches of encoded maps as tensors. Include from .cc files only: this header pulls in torch.
#pragma once

#include <torch/torch.h>

#include <condition_variable>
#include <deque>
#include <exception>
#include <functional>
#include <mutex>
#include <thread>

#include "training/train_options.h"

namespace glint {

struct BatchShape {
  int count = 0, crop = 0;
};

// Of batch `batch`: one of the options' crops, and as many as have the texels of a whole batch.
BatchShape BatchShapeOf(const TrainOptions& options, std::int64_t batch);

// The pool's crops of a training, [count, 9, crop, crop] on the training's device. Batches are cut
// ahead by a thread of its own and the pool's, for a GPU into pinned memory.
class MapBatches {
 public:
  using ShapeOf = std::function<BatchShape(std::int64_t batch)>;
  // `shape_of` depends on the batch's number alone; empty: BatchShapeOf().
  MapBatches(const TrainOptions& options, const MaterialSource& materials, std::int64_t first_batch,
             ShapeOf shape_of = {});
  ~MapBatches();

  // Batches in order: the first asked for, then one after the other.
  torch::Tensor Sample(std::int64_t batch);
  // Before the first Sample().
  torch::Tensor SampleFirst(int count, int crop);

  // How long Sample() has waited for batches, in all.
  double waited_seconds() const { return waited_seconds_; }

 private:
  void CutAhead(std::int64_t first);
  torch::Tensor Cut(std::int64_t batch);

  const torch::Device device_;
  const size_t ahead_;
  const ShapeOf shape_of_;
  MaterialPool pool_;
  std::int64_t next_ = -1;  // the batch that Sample() gives next; −1: any
  double waited_seconds_ = 0;
  std::deque<torch::Tensor> ready_;  // from next_ on
  bool stop_ = false;
  std::exception_ptr failure_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::thread cutter_;
};

// The first sixteen materials of a source, encoded: [16, 9, size, size].
torch::Tensor ValidationMaps(const MaterialSource& source, int size);

}  // namespace glint
