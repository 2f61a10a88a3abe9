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

namespace {

void ReadSinglePhotograph(const std::filesystem::path& path, const TensorFile& file,
                          EstimatorNetwork* network) {
  std::map<std::string, torch::Tensor> tensors;
  for (const TensorRecord& record : file.tensors) {
    tensors[record.name] = ReadTensor(path, file, record.name, record.shape);
  }
  // The network's own tensors have at least v1's sizes, in every dimension.
  for (const auto& [name, tensor] : network->State()) {
    if (name.starts_with("photograph.") || name.find("residual") != std::string::npos) continue;
    const auto found = tensors.find(name);
    bool fits = found != tensors.end() && found->second.dim() == tensor->dim();
    for (int64_t d = 0; fits && d < tensor->dim(); ++d) {
      fits = d < 2 ? found->second.size(d) <= tensor->size(d)
                   : found->second.size(d) == tensor->size(d);
    }
    if (!fits) FailWeights(path, name, "no such tensor, or another shape", "take another file");
  }
  network->AdoptSinglePhotograph(tensors);
}

}  // namespace

LoadedEstimator LoadEstimator(const std::filesystem::path& path) {
  const TensorFile file = ReadTensorFile(path);
  const bool single = RequireMetadata(path, file, "architecture") == kSinglePhotographArchitecture;
  const EstimatorKind kind = single ? EstimatorKind::kPooled : KindOf(path, file);
  CheckMetadata(path, file, "encoding", kEncodingName);
  const std::vector<int> list =
      ParseChannels(path, RequireMetadata(path, file, "channels"), kChannelNumbers);
  LoadedEstimator loaded{EstimatorNetwork::Random(FromList(list), 0, kind), single};
  if (single) {
    ReadSinglePhotograph(path, file, &loaded.network);
    return loaded;
  }
  for (auto& [name, tensor] : loaded.network.State()) {
    *tensor = ReadTensor(path, file, name, tensor->sizes().vec());
  }
  return loaded;
}

}  // namespace glint
