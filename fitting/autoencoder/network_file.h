// The auto-encoder's weights file. Include from .cc files only: this header pulls in torch.
#pragma once

#include <filesystem>
#include <map>
#include <string>

#include "fitting/autoencoder/network.h"
#include "fitting/weights/tensor_records.h"

namespace glint {

inline constexpr char kAutoencoderArchitecture[] = "glint-autoencoder v2";

// What a file of this network says of itself: architecture, encoding, channels.
std::map<std::string, std::string> NetworkMetadata(const AutoencoderNetwork& network);

// The network's state from a file's tensors PREFIX + name. Throws std::runtime_error when the
// metadata or a tensor is not as this version writes it.
AutoencoderNetwork ReadNetwork(const std::filesystem::path& path, const TensorFile& file,
                               const std::string& prefix);

// Weights for users: bf16 or float32, the code's statistics float32.
void SaveNetwork(const std::filesystem::path& path, AutoencoderNetwork* network,
                 std::map<std::string, std::string> metadata, bool bf16 = true);
AutoencoderNetwork LoadNetwork(const std::filesystem::path& path);

}  // namespace glint
