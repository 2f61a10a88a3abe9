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

std::string ArchitectureOf(EstimatorKind kind) {
  const std::string architecture = kEstimatorArchitecture;
  return kind == EstimatorKind::kPooled ? architecture
                                        : architecture + " " + EstimatorKindName(kind);
}

// The network that a file names; other names are refused.
EstimatorKind KindOf(const std::filesystem::path& path, const TensorFile& file) {
  const std::string found = RequireMetadata(path, file, "architecture");
  for (const EstimatorKind kind : {EstimatorKind::kAttended, EstimatorKind::kDescent}) {
    if (found == ArchitectureOf(kind)) return kind;
  }
  CheckMetadata(path, file, "architecture", kEstimatorArchitecture);
  return EstimatorKind::kPooled;
}

}  // namespace

std::map<std::string, std::string> EstimatorMetadata(const EstimatorNetwork& network) {
  return {{"architecture", ArchitectureOf(network.kind)},
          {"encoding", kEncodingName},
          {"channels", ChannelText(ChannelList(network.channels))}};
}

void SaveEstimator(const std::filesystem::path& path, EstimatorNetwork* network,
                   std::map<std::string, std::string> metadata, bool bf16) {
  TensorFile file;
  file.metadata = std::move(metadata);
  file.metadata.merge(EstimatorMetadata(*network));
  for (auto& [name, t] : network->State()) file.tensors.push_back(ToRecord(name, *t, bf16));
  WriteTensorFile(path, std::move(file));
}

EstimatorNetwork LoadEstimator(const std::filesystem::path& path) {
  const TensorFile file = ReadTensorFile(path);
  const EstimatorKind kind = KindOf(path, file);
  CheckMetadata(path, file, "encoding", kEncodingName);
  const std::vector<int> list =
      ParseChannels(path, RequireMetadata(path, file, "channels"), kChannelNumbers);
  EstimatorNetwork network = EstimatorNetwork::Random(FromList(list), 0, kind);
  for (auto& [name, tensor] : network.State()) {
    *tensor = ReadTensor(path, file, name, tensor->sizes().vec());
  }
  return network;
}

}  // namespace glint
