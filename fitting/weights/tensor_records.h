// Torch tensors in weights files. Include from .cc files only: this header pulls in torch.
#pragma once

#include <torch/torch.h>

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "fitting/weights/safetensors.h"

namespace glint {

// A network's tensors with their names in weights files, in a fixed order.
using NamedTensors = std::vector<std::pair<std::string, torch::Tensor*>>;

// Gives each tensor of `to` storage of its own with the values of the one at its place in `from`.
void CopyTensors(const NamedTensors& from, const NamedTensors& to);

TensorRecord ToRecord(const std::string& name, const torch::Tensor& tensor, bool bf16);

// Throws std::runtime_error when `file`, read from `path`, lacks the tensor or its shape differs.
torch::Tensor ReadTensor(const std::filesystem::path& path, const TensorFile& file,
                         const std::string& name, const std::vector<std::int64_t>& shape);

// Throws std::runtime_error "PATH: FIELD: found FOUND; REMEDY".
[[noreturn]] void FailWeights(const std::filesystem::path& path, const std::string& field,
                              const std::string& found, const std::string& remedy);

// Throws when the entry is missing, the second also when it is not `wanted`.
std::string RequireMetadata(const std::filesystem::path& path, const TensorFile& file,
                            const std::string& key);
void CheckMetadata(const std::filesystem::path& path, const TensorFile& file,
                   const std::string& key, const std::string& wanted);

// "32,64,128": channels in metadata. Parsing throws unless there are `count` numbers in 1…4096.
std::string ChannelText(const std::vector<int>& channels);
std::vector<int> ParseChannels(const std::filesystem::path& path, const std::string& text,
                               size_t count);

}  // namespace glint
