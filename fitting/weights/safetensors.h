// Reads and writes weights in the safetensors format (https://huggingface.co/docs/safetensors):
// eight bytes of header length (little-endian), a JSON header, raw little-endian tensors one after
// another.
//
// On writing, the metadata entry "checksum" gets the FNV-1a hash (64 bit, hexadecimal) of the
// tensor bytes; reading checks it when present. All errors are std::runtime_error with a message of
// the form "FILE: PART: found …; REMEDY".
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <span>
#include <string>
#include <vector>

namespace glint {

struct TensorRecord {
  std::string name;
  std::string dtype;                // "F32" or "BF16"; others are read, not interpreted
  std::vector<std::int64_t> shape;  // row-major
  std::vector<std::byte> bytes;
};

struct TensorFile {
  std::map<std::string, std::string> metadata;
  std::vector<TensorRecord> tensors;

  const TensorRecord* Find(const std::string& name) const;
};

// Written beside `path` and renamed, so that a reader never sees half a file.
void WriteTensorFile(const std::filesystem::path& path, TensorFile file);

TensorFile ReadTensorFile(const std::filesystem::path& path);

// bf16 values are the upper half of a float32, rounded to nearest even.
TensorRecord MakeRecord(const std::string& name, std::vector<std::int64_t> shape,
                        std::span<const float> values, bool as_bf16);
std::vector<float> RecordValues(const TensorRecord& record);  // throws for other dtypes

std::uint64_t Fnv1a64(std::span<const std::byte> bytes, std::uint64_t hash = 0xCBF29CE484222325ull);

}  // namespace glint
