#include "training/checkpoint.h"

#include <stdexcept>

namespace glint {
namespace {

using torch::Tensor;

// Tensors keep their identity: the network holds pointers to them.
void ReadAll(const std::filesystem::path& path, const TensorFile& file, const std::string& prefix,
             const NamedTensors& tensors) {
  for (const auto& [name, tensor] : tensors) {
    *tensor = ReadTensor(path, file, prefix + name, tensor->sizes().vec()).to(tensor->device());
  }
}

double Number(const std::filesystem::path& path, const TensorFile& file, const std::string& key) {
  const std::string text = RequireMetadata(path, file, key);
  try {
    return std::stod(text);
  } catch (const std::logic_error&) {
    FailWeights(path, key, "\"" + text + "\"", "start without --resume");
  }
}

// Checkpoints from before steps could be taken back do not name it.
std::int64_t BatchOf(const std::filesystem::path& path, const TensorFile& file, int accumulate) {
  if (file.metadata.contains("batch")) {
    return static_cast<std::int64_t>(Number(path, file, "batch"));
  }
  return static_cast<std::int64_t>(Number(path, file, "step")) * accumulate;
}

}  // namespace

TrainState TrainState::From(NamedTensors network, NamedTensors average, size_t learned) {
  TrainState state;
  for (size_t i = 0; i < learned; ++i) {
    state.moment1.push_back(torch::zeros_like(*network[i].second));
    state.moment2.push_back(torch::zeros_like(*network[i].second));
  }
  state.network = std::move(network);
  state.average = std::move(average);
  return state;
}

void SaveCheckpoint(const std::filesystem::path& path, const TrainState& state,
                    const std::map<std::string, std::string>& description) {
  TensorFile file;
  file.metadata = description;
  file.metadata["step"] = std::to_string(state.step);
  file.metadata["batch"] = std::to_string(state.batch);
  file.metadata["rate_factor"] = std::to_string(state.rate_factor);
  file.metadata["seconds"] = std::to_string(state.seconds);
  for (const auto& [name, t] : state.network) file.tensors.push_back(ToRecord(name, *t, false));
  for (const auto& [name, t] : state.average) {
    file.tensors.push_back(ToRecord("average." + name, *t, false));
  }
  for (size_t i = 0; i < state.moment1.size(); ++i) {
    const std::string& name = state.network[i].first;
    file.tensors.push_back(ToRecord("moment1." + name, state.moment1[i], false));
    file.tensors.push_back(ToRecord("moment2." + name, state.moment2[i], false));
  }
  WriteTensorFile(path, std::move(file));
}

void LoadCheckpoint(const std::filesystem::path& path,
                    const std::map<std::string, std::string>& description, int accumulate,
                    TrainState* state) {
  const TensorFile file = ReadTensorFile(path);
  for (const auto& [key, wanted] : description) {
    const std::string found = RequireMetadata(path, file, key);
    if (found != wanted) {
      FailWeights(path, key, "\"" + found + "\"",
                  "this training has \"" + wanted + "\"; resume with the checkpoint's " + key +
                      " or start without --resume");
    }
  }
  ReadAll(path, file, "", state->network);
  ReadAll(path, file, "average.", state->average);
  for (size_t i = 0; i < state->moment1.size(); ++i) {
    const std::string& name = state->network[i].first;
    const std::vector<std::int64_t> shape = state->moment1[i].sizes().vec();
    const torch::Device device = state->moment1[i].device();
    state->moment1[i] = ReadTensor(path, file, "moment1." + name, shape).to(device);
    state->moment2[i] = ReadTensor(path, file, "moment2." + name, shape).to(device);
  }
  state->step = static_cast<std::int64_t>(Number(path, file, "step"));
  state->batch = BatchOf(path, file, accumulate);
  state->seconds = Number(path, file, "seconds");
  state->rate_factor =
      file.metadata.contains("rate_factor") ? Number(path, file, "rate_factor") : 1;
}

std::int64_t CheckpointBatch(const std::filesystem::path& path, int accumulate) {
  return BatchOf(path, ReadTensorFile(path), accumulate);
}

}  // namespace glint
