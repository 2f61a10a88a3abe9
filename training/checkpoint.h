// Everything that a training run must remember. Include from .cc files only.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "fitting/weights/tensor_records.h"

namespace glint {

struct TrainState {
  NamedTensors network;                         // learned tensors first
  NamedTensors average;                         // the same, averaged
  std::vector<torch::Tensor> moment1, moment2;  // Adam's, of the learned ones
  std::int64_t step = 0;
  std::int64_t batch = 0;  // the next one's number: it rises even where steps are taken back
  double seconds = 0;
  double rate_factor = 1;  // of the learning rate: what is left of it after jumps of the loss

  static TrainState From(NamedTensors network, NamedTensors average, size_t learned);
};

void SaveCheckpoint(const std::filesystem::path& path, const TrainState& state,
                    const std::map<std::string, std::string>& description);

// Overwrites the tensors. Throws std::runtime_error when the file's metadata differ from
// `description`.
void LoadCheckpoint(const std::filesystem::path& path,
                    const std::map<std::string, std::string>& description, int accumulate,
                    TrainState* state);

// The number of the batch that a training goes on with from a checkpoint; `accumulate` of them make
// a step.
std::int64_t CheckpointBatch(const std::filesystem::path& path, int accumulate);

}  // namespace glint
