#include "fitting/autoencoder/network_file.h"

#include <algorithm>

#include "fitting/encoding/encoding.h"

namespace glint {
namespace {

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

}  // namespace

std::map<std::string, std::string> NetworkMetadata(const AutoencoderNetwork& network) {
  return {{"architecture", kAutoencoderArchitecture},
          {"encoding", kEncodingName},
          {"channels", ChannelText({network.channels.begin(), network.channels.end()})}};
}

AutoencoderNetwork ReadNetwork(const std::filesystem::path& path, const TensorFile& file,
                               const std::string& prefix) {
  CheckMetadata(path, file, "architecture", kAutoencoderArchitecture);
  CheckMetadata(path, file, "encoding", kEncodingName);
  const std::vector<int> channels =
      ParseChannels(path, RequireMetadata(path, file, "channels"), kLevels);
  AutoencoderNetwork network;
  std::copy(channels.begin(), channels.end(), network.channels.begin());
  const auto shapes = ParameterShapes(network.channels);
  auto state = network.State();
  for (size_t i = 0; i < state.size(); ++i) {
    *state[i].second = ReadTensor(path, file, prefix + state[i].first, shapes[i]);
  }
  return network;
}

void SaveNetwork(const std::filesystem::path& path, AutoencoderNetwork* network,
                 std::map<std::string, std::string> metadata) {
  TensorFile file;
  file.metadata = std::move(metadata);
  file.metadata.merge(NetworkMetadata(*network));
  for (auto& [name, t] : network->State()) {
    file.tensors.push_back(ToRecord(name, *t, name.rfind("code.", 0) != 0));
  }
  WriteTensorFile(path, std::move(file));
}

AutoencoderNetwork LoadNetwork(const std::filesystem::path& path) {
  return ReadNetwork(path, ReadTensorFile(path), "");
}

}  // namespace glint
