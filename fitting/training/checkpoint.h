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
  double seconds = 0;

  static TrainState From(NamedTensors network, NamedTensors average, size_t learned);
};

void SaveCheckpoint(const std::filesystem::path& path, const TrainState& state,
                    const std::map<std::string, std::string>& description);

// Overwrites the tensors. Throws std::runtime_error when the file's metadata differ from
// `description`.
void LoadCheckpoint(const std::filesystem::path& path,
                    const std::map<std::string, std::string>& description, TrainState* state);

// The step a checkpoint was written after.
std::int64_t CheckpointStep(const std::filesystem::path& path);

}  // namespace glint
