#include "fitting/estimator/estimator_file.h"

#include <algorithm>

#include "fitting/encoding/encoding.h"

namespace glint {
namespace {

constexpr size_t kChannelNumbers = kEstimatorLevels + 2;

std::vector<int> ChannelList(const EstimatorChannels& channels) {
  std::vector<int> list(channels.levels.begin(), channels.levels.end());
  list.push_back(channels.full);
  list.push_back(channels.global);
  return list;
}

EstimatorChannels FromList(const std::vector<int>& list) {
  EstimatorChannels channels;
  std::copy_n(list.begin(), kEstimatorLevels, channels.levels.begin());
  channels.full = list[kEstimatorLevels];
  channels.global = list[kEstimatorLevels + 1];
  return channels;
}

}  // namespace

std::map<std::string, std::string> EstimatorMetadata(const EstimatorNetwork& network) {
  return {{"architecture", kEstimatorArchitecture},
          {"encoding", kEncodingName},
          {"channels", ChannelText(ChannelList(network.channels))}};
}

void SaveEstimator(const std::filesystem::path& path, EstimatorNetwork* network,
                   std::map<std::string, std::string> metadata) {
  TensorFile file;
  file.metadata = std::move(metadata);
  file.metadata.merge(EstimatorMetadata(*network));
  for (auto& [name, t] : network->State()) file.tensors.push_back(ToRecord(name, *t, true));
  WriteTensorFile(path, std::move(file));
}

EstimatorNetwork LoadEstimator(const std::filesystem::path& path) {
  const TensorFile file = ReadTensorFile(path);
  CheckMetadata(path, file, "architecture", kEstimatorArchitecture);
  CheckMetadata(path, file, "encoding", kEncodingName);
  const std::vector<int> list =
      ParseChannels(path, RequireMetadata(path, file, "channels"), kChannelNumbers);
  EstimatorNetwork network = EstimatorNetwork::Random(FromList(list), 0);
  for (auto& [name, tensor] : network.State()) {
    *tensor = ReadTensor(path, file, name, tensor->sizes().vec());
  }
  return network;
}

}  // namespace glint
