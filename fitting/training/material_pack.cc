#include "fitting/training/material_pack.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <stdexcept>

#include "fitting/encoding/encoding.h"
#include "fitting/weights/safetensors.h"

namespace glint {
namespace {

constexpr float kScale = 32767.0f;

[[noreturn]] void Fail(const std::filesystem::path& path, const std::string& part,
                       const std::string& found) {
  throw std::runtime_error(path.string() + ": " + part + ": found " + found +
                           "; write the pack again with `glint-synth pack`");
}

void CheckEntry(const std::filesystem::path& path, const TensorFile& file, const std::string& key,
                const std::string& wanted) {
  const auto entry = file.metadata.find(key);
  const std::string found = entry == file.metadata.end() ? "" : entry->second;
  if (found != wanted) Fail(path, key, "\"" + found + "\" where \"" + wanted + "\" is expected");
}

// Weights of `count` output texels over a window of `window`: output i covers
// [i, i + 1)·window/count.
struct Span {
  int first, last;  // inclusive
  double first_weight, last_weight;
};

Span SpanOf(int i, int window, int count) {
  const double step = static_cast<double>(window) / count;
  const double begin = i * step, end = (i + 1) * step;
  const int first = static_cast<int>(begin);
  const int last = std::min(window - 1, static_cast<int>(std::ceil(end - 1e-9)) - 1);
  if (first == last) return {first, last, end - begin, end - begin};
  return {first, last, first + 1 - begin, end - last};
}

double WeightIn(const Span& span, int k) {
  return k == span.first ? span.first_weight : k == span.last ? span.last_weight : 1.0;
}

}  // namespace

PackedMaterial PackMaterial(const std::string& name, const SvbrdfMaps& maps) {
  if (maps.width != maps.height || maps.width < 1) {
    throw std::invalid_argument("material pack: " + name + " is not square");
  }
  const EncodedMaps encoded = EncodeMaps(maps);
  PackedMaterial packed{name, maps.width, std::vector<std::int16_t>(encoded.planes.size())};
  std::transform(encoded.planes.begin(), encoded.planes.end(), packed.values.begin(),
                 [](float t) { return static_cast<std::int16_t>(std::lround(t * kScale)); });
  return packed;
}

void WriteMaterialPack(const std::filesystem::path& path, const MaterialPack& pack) {
  TensorFile file;
  file.metadata = {{"kind", kMaterialPackKind}, {"encoding", kEncodingName}};
  for (const PackedMaterial& material : pack) {
    TensorRecord record{material.name, "I16", {kEncodedChannels, material.size, material.size}, {}};
    record.bytes.resize(material.values.size() * sizeof(std::int16_t));
    std::memcpy(record.bytes.data(), material.values.data(), record.bytes.size());
    file.tensors.push_back(std::move(record));
  }
  WriteTensorFile(path, std::move(file));
}

MaterialPack ReadMaterialPack(const std::filesystem::path& path) {
  TensorFile file = ReadTensorFile(path);
  CheckEntry(path, file, "kind", kMaterialPackKind);
  CheckEntry(path, file, "encoding", kEncodingName);
  MaterialPack pack;
  for (TensorRecord& record : file.tensors) {
    const auto& shape = record.shape;
    if (record.dtype != "I16" || shape.size() != 3 || shape[0] != kEncodedChannels ||
        shape[1] != shape[2] || shape[1] < 1) {
      Fail(path, "material " + record.name, "a tensor that is no square map of type I16");
    }
    PackedMaterial material{record.name, static_cast<int>(shape[1]),
                            std::vector<std::int16_t>(record.bytes.size() / sizeof(std::int16_t))};
    std::memcpy(material.values.data(), record.bytes.data(), record.bytes.size());
    record.bytes = {};
    pack.push_back(std::move(material));
  }
  if (pack.empty()) Fail(path, "materials", "none");
  return pack;
}

SvbrdfMaps CutMaterial(const PackedMaterial& material, int column, int row, int window, int size) {
  if (size < 1 || window < size || column < 0 || row < 0 || column + window > material.size ||
      row + window > material.size) {
    throw std::invalid_argument("material pack: the window does not lie in " + material.name);
  }
  EncodedMaps cut(window, window);
  for (int k = 0; k < kEncodedChannels; ++k) {
    for (int y = 0; y < window; ++y) {
      const std::int16_t* from =
          material.values.data() +
          (static_cast<size_t>(k) * material.size + row + y) * material.size + column;
      float* to = cut.planes.data() + (static_cast<size_t>(k) * window + y) * window;
      for (int x = 0; x < window; ++x) to[x] = from[x] / kScale;
    }
  }
  SvbrdfMaps fine = DecodeMaps(cut);
  if (window == size) return fine;
  // Slopes average, not normals.
  for (size_t i = 0; i < fine.texels(); ++i) {
    const float z = fine.plane(kNormalZ)[i];
    fine.plane(kNormalX)[i] /= z;
    fine.plane(kNormalY)[i] /= z;
    fine.plane(kNormalZ)[i] = 1;
  }
  std::vector<Span> spans;
  for (int i = 0; i < size; ++i) spans.push_back(SpanOf(i, window, size));
  SvbrdfMaps maps(size, size);
  const double area = static_cast<double>(window) / size * window / size;
  for (int p = 0; p < kSvbrdfPlanes; ++p) {
    for (int y = 0; y < size; ++y) {
      for (int x = 0; x < size; ++x) {
        double sum = 0;
        for (int v = spans[y].first; v <= spans[y].last; ++v) {
          for (int u = spans[x].first; u <= spans[x].last; ++u) {
            sum += WeightIn(spans[y], v) * WeightIn(spans[x], u) * fine.at(p, v, u);
          }
        }
        maps.at(p, y, x) = static_cast<float>(sum / area);
      }
    }
  }
  for (size_t i = 0; i < maps.texels(); ++i) {
    const float sx = maps.plane(kNormalX)[i], sy = maps.plane(kNormalY)[i];
    const float z = 1 / std::sqrt(1 + sx * sx + sy * sy);
    maps.plane(kNormalX)[i] = sx * z;
    maps.plane(kNormalY)[i] = sy * z;
    maps.plane(kNormalZ)[i] = z;
  }
  return maps;
}

}  // namespace glint
