#include "fitting/weights/tensor_records.h"

#include <charconv>
#include <sstream>
#include <stdexcept>

namespace glint {
namespace {

using torch::Tensor;

constexpr int kMaxChannels = 4096;

}  // namespace

void CopyTensors(const NamedTensors& from, const NamedTensors& to) {
  for (size_t i = 0; i < to.size(); ++i) *to[i].second = from[i].second->detach().clone();
}

TensorRecord ToRecord(const std::string& name, const Tensor& tensor, bool bf16) {
  const Tensor t = tensor.detach().to(torch::kCPU, torch::kFloat32).contiguous();
  return MakeRecord(name, t.sizes().vec(), {t.data_ptr<float>(), static_cast<size_t>(t.numel())},
                    bf16);
}

Tensor ReadTensor(const std::filesystem::path& path, const TensorFile& file,
                  const std::string& name, const std::vector<std::int64_t>& shape) {
  const TensorRecord* record = file.Find(name);
  if (record == nullptr) {
    FailWeights(path, "tensor " + name, "nothing", "give weights written by glint-train");
  }
  if (record->shape != shape) {
    FailWeights(path, "tensor " + name, "another shape than the channels in the metadata prescribe",
                "give weights written by glint-train");
  }
  std::vector<float> values = RecordValues(*record);
  return torch::from_blob(values.data(), shape, torch::kFloat32).clone();
}

void FailWeights(const std::filesystem::path& path, const std::string& field,
                 const std::string& found, const std::string& remedy) {
  throw std::runtime_error(path.string() + ": " + field + ": found " + found + "; " + remedy);
}

std::string RequireMetadata(const std::filesystem::path& path, const TensorFile& file,
                            const std::string& key) {
  const auto entry = file.metadata.find(key);
  if (entry == file.metadata.end()) {
    FailWeights(path, key, "nothing in the file's metadata", "give weights written by glint-train");
  }
  return entry->second;
}

void CheckMetadata(const std::filesystem::path& path, const TensorFile& file,
                   const std::string& key, const std::string& wanted) {
  const std::string found = RequireMetadata(path, file, key);
  if (found != wanted) {
    FailWeights(path, key, "\"" + found + "\"", "this program reads \"" + wanted + "\"");
  }
}

std::string ChannelText(const std::vector<int>& channels) {
  std::string text;
  for (const int c : channels) {
    if (!text.empty()) text += ',';
    text += std::to_string(c);
  }
  return text;
}

std::vector<int> ParseChannels(const std::filesystem::path& path, const std::string& text,
                               size_t count) {
  std::vector<int> channels;
  std::istringstream in(text);
  std::string part;
  while (std::getline(in, part, ',')) {
    int value = 0;
    const auto end = std::from_chars(part.data(), part.data() + part.size(), value);
    if (end.ptr != part.data() + part.size() || value < 1 || value > kMaxChannels) break;
    channels.push_back(value);
  }
  if (!in.eof() || channels.size() != count) {
    FailWeights(path, "channels", "\"" + text + "\"",
                std::to_string(count) + " numbers from 1 to 4096 are expected");
  }
  return channels;
}

}  // namespace glint
