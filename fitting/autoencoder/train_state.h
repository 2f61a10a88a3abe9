// Everything that a training run must remember, and its checkpoint file. Include from .cc files only.
#pragma once

#include <filesystem>
#include <string>

#include "fitting/autoencoder/network.h"
#include "fitting/autoencoder/safetensors.h"

namespace glint {

struct TrainState {
  AutoencoderNetwork network;
  AutoencoderNetwork average;  // moving average of the weights and of the code's statistics
  std::vector<torch::Tensor> moment1, moment2;  // of network.Parameters(), in order
  std::int64_t step = 0;
  double seconds = 0;

  // Step 0 from these weights.
  static TrainState From(AutoencoderNetwork network);
};

void SaveCheckpoint(const std::filesystem::path& path, TrainState* state);
// Throws when the file's channels are not `channels`.
TrainState LoadCheckpoint(const std::filesystem::path& path, const NetworkChannels& channels);

// Weights for users: bf16, the code's statistics float32. Metadata: architecture, channels, encoding.
void SaveNetwork(const std::filesystem::path& path, AutoencoderNetwork* network,
                 std::map<std::string, std::string> metadata);
AutoencoderNetwork LoadNetwork(const std::filesystem::path& path);

}  // namespace glint
