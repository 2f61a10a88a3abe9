// What Adam works on, in one buffer each, so that a step is a few operations whatever the number of
// tensors. Include from .cc files only: pulls in torch.
#pragma once

#include "training/checkpoint.h"

namespace glint {

struct FlatState {
  torch::Tensor weights, average, moment1, moment2, gradients;  // [P], of the learned tensors

  // Moves the learned tensors of `state` into buffers; they become views of them, and so do their
  // gradients, in which backward passes add up.
  explicit FlatState(TrainState* state);
};

// A state's values at one moment, on its own device.
class Snapshot {
 public:
  Snapshot(const FlatState& flat, const TrainState& state);
  // Gives both the values back, and the step. What has been trained since counts as time.
  void Restore(FlatState* flat, TrainState* state) const;
  std::int64_t step() const { return step_; }

 private:
  torch::Tensor weights_, average_, moment1_, moment2_;
  std::vector<torch::Tensor> other_, other_average_;  // what is not learned
  std::int64_t step_ = 0;
};

}  // namespace glint
