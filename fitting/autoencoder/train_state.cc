#include "fitting/autoencoder/train_state.h"

#include <charconv>
#include <sstream>
#include <stdexcept>

#include "fitting/autoencoder/encoding.h"

namespace glint {
namespace {

using torch::Tensor;

constexpr char kArchitecture[] = "glint-autoencoder v2";
constexpr int kMaxChannels = 4096;

std::vector<Tensor> ZerosLike(AutoencoderNetwork* network) {
  std::vector<Tensor> zeros;
  for (auto& [name, tensor] : network->Parameters()) zeros.push_back(torch::zeros_like(*tensor));
  return zeros;
}

AutoencoderNetwork Clone(AutoencoderNetwork* network) {
  AutoencoderNetwork copy;
  copy.channels = network->channels;
  auto to = copy.State();
  auto from = network->State();
  for (size_t i = 0; i < to.size(); ++i) *to[i].second = from[i].second->detach().clone();
  return copy;
}

TensorRecord ToRecord(const std::string& name, const Tensor& tensor, bool bf16) {
  const Tensor t = tensor.detach().to(torch::kFloat32).contiguous();
  return MakeRecord(name, t.sizes().vec(), {t.data_ptr<float>(), static_cast<size_t>(t.numel())},
                    bf16);
}

std::string ChannelText(const NetworkChannels& channels) {
  std::string text;
  for (const int c : channels) text += (text.empty() ? "" : ",") + std::to_string(c);
  return text;
}

[[noreturn]] void Fail(const std::filesystem::path& path, const std::string& field,
                       const std::string& found, const std::string& mend) {
  throw std::runtime_error(path.string() + ": " + field + ": found " + found + "; " + mend);
}

std::string Metadata(const std::filesystem::path& path, const TensorFile& file,
                     const std::string& key) {
  const auto entry = file.metadata.find(key);
  if (entry == file.metadata.end()) {
    Fail(path, key, "nothing in the file's metadata", "give weights written by glint-train");
  }
  return entry->second;
}

NetworkChannels ParseChannels(const std::filesystem::path& path, const std::string& text) {
  NetworkChannels channels{};
  std::istringstream in(text);
  std::string part;
  size_t count = 0;
  while (std::getline(in, part, ',')) {
    int value = 0;
    const auto end = std::from_chars(part.data(), part.data() + part.size(), value);
    if (count >= channels.size() || end.ptr != part.data() + part.size() || value < 1 ||
        value > kMaxChannels) {
      count = 0;
      break;
    }
    channels[count++] = value;
  }
  if (count != channels.size()) {
    Fail(path, "channels", "\"" + text + "\"", "five numbers from 1 to 4096 are expected");
  }
  return channels;
}

// Shapes that `channels` prescribe, without drawing the weights first.
std::vector<std::vector<std::int64_t>> ParameterShapes(const NetworkChannels& channels) {
  std::vector<std::vector<std::int64_t>> shapes;
  for (int i = 0; i < kLevels; ++i) {
    shapes.push_back({channels[i], i == 0 ? kEncodedChannels : channels[i - 1], 4, 4});
    shapes.push_back({channels[i]});
  }
  for (int i = 0; i < kLevels; ++i) {
    const std::int64_t out = 4 * (i == kLevels - 1 ? kEncodedChannels : channels[kLevels - 2 - i]);
    shapes.push_back({out, channels[kLevels - 1 - i], 2, 2});
    shapes.push_back({out});
  }
  shapes.push_back({channels[kLevels - 1]});
  shapes.push_back({channels[kLevels - 1]});
  return shapes;
}

Tensor ReadTensor(const std::filesystem::path& path, const TensorFile& file,
                  const std::string& name, const std::vector<std::int64_t>& shape) {
  const TensorRecord* record = file.Find(name);
  if (record == nullptr) {
    Fail(path, "tensor " + name, "nothing", "give weights written by glint-train");
  }
  if (record->shape != shape) {
    Fail(path, "tensor " + name, "another shape than the channels in the metadata prescribe",
         "give weights written by glint-train");
  }
  std::vector<float> values = RecordValues(*record);
  return torch::from_blob(values.data(), shape, torch::kFloat32).clone();
}

AutoencoderNetwork ReadState(const std::filesystem::path& path, const TensorFile& file,
                             const std::string& prefix) {
  AutoencoderNetwork network;
  network.channels = ParseChannels(path, Metadata(path, file, "channels"));
  const auto shapes = ParameterShapes(network.channels);
  auto state = network.State();
  for (size_t i = 0; i < state.size(); ++i) {
    *state[i].second = ReadTensor(path, file, prefix + state[i].first, shapes[i]);
  }
  return network;
}

void CheckKind(const std::filesystem::path& path, const TensorFile& file) {
  const std::string architecture = Metadata(path, file, "architecture");
  if (architecture != kArchitecture) {
    Fail(path, "architecture", "\"" + architecture + "\"",
         std::string("this version reads \"") + kArchitecture + "\"");
  }
  const std::string encoding = Metadata(path, file, "encoding");
  if (encoding != kEncodingName) {
    Fail(path, "encoding", "\"" + encoding + "\"",
         std::string("this version reads \"") + kEncodingName + "\"");
  }
}

}  // namespace

TrainState TrainState::From(AutoencoderNetwork network) {
  TrainState state;
  state.network = std::move(network);
  state.average = Clone(&state.network);
  state.moment1 = ZerosLike(&state.network);
  state.moment2 = ZerosLike(&state.network);
  return state;
}

void SaveCheckpoint(const std::filesystem::path& path, TrainState* state) {
  TensorFile file;
  file.metadata = {{"architecture", kArchitecture},
                   {"encoding", kEncodingName},
                   {"channels", ChannelText(state->network.channels)},
                   {"step", std::to_string(state->step)},
                   {"seconds", std::to_string(state->seconds)}};
  for (auto& [name, t] : state->network.State()) file.tensors.push_back(ToRecord(name, *t, false));
  for (auto& [name, t] : state->average.State()) {
    file.tensors.push_back(ToRecord("average." + name, *t, false));
  }
  const auto parameters = state->network.Parameters();
  for (size_t i = 0; i < parameters.size(); ++i) {
    file.tensors.push_back(ToRecord("moment1." + parameters[i].first, state->moment1[i], false));
    file.tensors.push_back(ToRecord("moment2." + parameters[i].first, state->moment2[i], false));
  }
  WriteTensorFile(path, std::move(file));
}

TrainState LoadCheckpoint(const std::filesystem::path& path, const NetworkChannels& channels) {
  const TensorFile file = ReadTensorFile(path);
  CheckKind(path, file);
  TrainState state;
  state.network = ReadState(path, file, "");
  if (state.network.channels != channels) {
    Fail(path, "channels", ChannelText(state.network.channels),
         "resume with --channels " + ChannelText(state.network.channels) +
             " or start without --resume");
  }
  state.average = ReadState(path, file, "average.");
  for (auto& [name, tensor] : state.network.Parameters()) {
    state.moment1.push_back(ReadTensor(path, file, "moment1." + name, tensor->sizes().vec()));
    state.moment2.push_back(ReadTensor(path, file, "moment2." + name, tensor->sizes().vec()));
  }
  try {
    state.step = std::stoll(Metadata(path, file, "step"));
    state.seconds = std::stod(Metadata(path, file, "seconds"));
  } catch (const std::logic_error&) {
    Fail(path, "step", "text that is not a number", "start without --resume");
  }
  return state;
}

void SaveNetwork(const std::filesystem::path& path, AutoencoderNetwork* network,
                 std::map<std::string, std::string> metadata) {
  TensorFile file;
  file.metadata = std::move(metadata);
  file.metadata["architecture"] = kArchitecture;
  file.metadata["encoding"] = kEncodingName;
  file.metadata["channels"] = ChannelText(network->channels);
  for (auto& [name, t] : network->State()) {
    file.tensors.push_back(ToRecord(name, *t, name.rfind("code.", 0) != 0));
  }
  WriteTensorFile(path, std::move(file));
}

AutoencoderNetwork LoadNetwork(const std::filesystem::path& path) {
  const TensorFile file = ReadTensorFile(path);
  CheckKind(path, file);
  return ReadState(path, file, "");
}

}  // namespace glint
