#include "fitting/autoencoder/network_file.h"

#include <algorithm>

#include "fitting/encoding/encoding.h"

namespace glint {
std::map<std::string, std::string> NetworkMetadata(const AutoencoderNetwork& network) {
  return {{"architecture", kAutoencoderArchitecture},
          {"encoding", kEncodingName},
          {"channels", ChannelText({network.channels.begin(), network.channels.end()})},
          {"normalisation", std::string(NormalisationName(network.normalisation))}};
}

AutoencoderNetwork ReadNetwork(const std::filesystem::path& path, const TensorFile& file,
                               const std::string& prefix) {
  CheckMetadata(path, file, "architecture", kAutoencoderArchitecture);
  CheckMetadata(path, file, "encoding", kEncodingName);
  const std::vector<int> channels =
      ParseChannels(path, RequireMetadata(path, file, "channels"), kLevels);
  NetworkChannels list;
  std::copy(channels.begin(), channels.end(), list.begin());
  // Files from before there was a choice have it on the code.
  const auto entry = file.metadata.find("normalisation");
  AutoencoderNetwork network = AutoencoderNetwork::Random(
      list, 0,
      entry == file.metadata.end() ? Normalisation::kCode : ParseNormalisation(entry->second));
  for (auto& [name, tensor] : network.State()) {
    *tensor = ReadTensor(path, file, prefix + name, tensor->sizes().vec());
  }
  return network;
}

void SaveNetwork(const std::filesystem::path& path, AutoencoderNetwork* network,
                 std::map<std::string, std::string> metadata, bool bf16) {
  TensorFile file;
  file.metadata = std::move(metadata);
  file.metadata.merge(NetworkMetadata(*network));
  for (auto& [name, t] : network->State()) {
    file.tensors.push_back(
        ToRecord(name, *t, bf16 && name.rfind("code.", 0) != 0 && name.rfind("level.", 0) != 0));
  }
  WriteTensorFile(path, std::move(file));
}

AutoencoderNetwork LoadNetwork(const std::filesystem::path& path) {
  return ReadNetwork(path, ReadTensorFile(path), "");
}

}  // namespace glint
