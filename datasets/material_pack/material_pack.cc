#include "datasets/material_pack/material_pack.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <stdexcept>

#include "base/resampling/resampling.h"
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

// The window's maps at the pack's own resolution.
SvbrdfMaps Window(const PackedMaterial& material, int column, int row, int window) {
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
  return DecodeMaps(cut);
}

void SlopesFromNormals(SvbrdfMaps* maps) {
  for (size_t i = 0; i < maps->texels(); ++i) {
    const float z = maps->plane(kNormalZ)[i];
    maps->plane(kNormalX)[i] /= z;
    maps->plane(kNormalY)[i] /= z;
    maps->plane(kNormalZ)[i] = 1;
  }
}

void NormalsFromSlopes(SvbrdfMaps* maps) {
  for (size_t i = 0; i < maps->texels(); ++i) {
    const float sx = maps->plane(kNormalX)[i], sy = maps->plane(kNormalY)[i];
    const float z = 1 / std::sqrt(1 + sx * sx + sy * sy);
    maps->plane(kNormalX)[i] = sx * z;
    maps->plane(kNormalY)[i] = sy * z;
    maps->plane(kNormalZ)[i] = z;
  }
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
  SvbrdfMaps fine = Window(material, column, row, window);
  if (window == size) return fine;
  SlopesFromNormals(&fine);  // slopes average, not normals
  const std::vector<Taps> taps = AreaTaps(window, size);
  SvbrdfMaps maps(size, size);
  maps.planes = ResamplePlanes(fine.planes, window, window, taps, taps);
  NormalsFromSlopes(&maps);
  return maps;
}

}  // namespace glint
