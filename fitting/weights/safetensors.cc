#include "fitting/weights/safetensors.h"

#include <bit>
#include <cmath>
#include <cstring>
#include <fstream>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "base/text/json_depth.h"

namespace glint {
namespace {

using Json = nlohmann::json;
static_assert(std::endian::native == std::endian::little, "safetensors is little-endian");

constexpr std::uint64_t kMaxHeaderBytes = 1u << 24;
constexpr char kRemedy[] = "the file is damaged or not a weights file: fetch or train it again";

[[noreturn]] void Fail(const std::filesystem::path& path, const std::string& part,
                       const std::string& found, const std::string& remedy = kRemedy) {
  throw std::runtime_error(path.string() + ": " + part + ": found " + found + "; " + remedy);
}

std::string Hex(std::uint64_t value) {
  char text[17];
  std::snprintf(text, sizeof text, "%016llx", static_cast<unsigned long long>(value));
  return text;
}

size_t DtypeBytes(const std::string& dtype) {
  if (dtype == "F64" || dtype == "I64" || dtype == "U64") return 8;
  if (dtype == "F32" || dtype == "I32" || dtype == "U32") return 4;
  if (dtype == "BF16" || dtype == "F16" || dtype == "I16" || dtype == "U16") return 2;
  if (dtype == "I8" || dtype == "U8" || dtype == "BOOL") return 1;
  return 0;
}

TensorRecord ReadRecord(const std::filesystem::path& path, const std::string& name,
                        const Json& entry, std::span<const std::byte> data) {
  TensorRecord record{name,
                      entry.at("dtype").get<std::string>(),
                      entry.at("shape").get<std::vector<std::int64_t>>(),
                      {}};
  const auto range = entry.at("data_offsets").get<std::array<std::uint64_t, 2>>();
  if (range[0] > range[1] || range[1] > data.size()) {
    Fail(path, "tensor " + name,
         "bytes " + std::to_string(range[0]) + " to " + std::to_string(range[1]) + " of " +
             std::to_string(data.size()));
  }
  // The product is compared against a size that is known to be in memory, so it cannot overflow.
  std::uint64_t wanted = DtypeBytes(record.dtype);
  const std::uint64_t held = range[1] - range[0];
  for (const std::int64_t n : record.shape) {
    if (n < 0 || (n > 0 && wanted > held / static_cast<std::uint64_t>(n)))
      wanted = held + 1;
    else
      wanted *= static_cast<std::uint64_t>(n);
    if (wanted > held) break;
  }
  if (wanted != held) {
    Fail(path, "tensor " + name,
         std::to_string(held) + " bytes, not what dtype " + record.dtype + " and shape " +
             entry.at("shape").dump() + " need");
  }
  record.bytes.assign(data.begin() + range[0], data.begin() + range[1]);
  return record;
}

// A network with one of these gives maps of one value, and nothing says why.
void RequireFinite(const std::filesystem::path& path, const TensorRecord& record) {
  if (record.dtype != "F32" && record.dtype != "BF16") return;
  for (const float value : RecordValues(record)) {
    if (!std::isfinite(value)) {
      Fail(path, "tensor " + record.name, "a value that is not finite");
    }
  }
}

std::vector<std::byte> ReadAll(const std::filesystem::path& path) {
  std::error_code error;
  if (std::filesystem::exists(path, error) && !std::filesystem::is_regular_file(path, error)) {
    Fail(path, "file", "something that is not a file", "give the path of a weights file");
  }
  const std::uintmax_t size = std::filesystem::file_size(path, error);
  std::ifstream in(path, std::ios::binary);
  if (error || !in) {
    Fail(path, "file", "nothing that can be read", "check the path and its permissions");
  }
  std::vector<std::byte> bytes(size);
  in.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(size));
  if (in.gcount() != static_cast<std::streamsize>(size)) Fail(path, "file", "a read error");
  return bytes;
}

}  // namespace

std::uint64_t Fnv1a64(std::span<const std::byte> bytes, std::uint64_t hash) {
  for (const std::byte b : bytes) hash = (hash ^ static_cast<std::uint64_t>(b)) * 0x100000001B3ull;
  return hash;
}

const TensorRecord* TensorFile::Find(const std::string& name) const {
  for (const TensorRecord& record : tensors) {
    if (record.name == name) return &record;
  }
  return nullptr;
}

void WriteTensorFile(const std::filesystem::path& path, TensorFile file) {
  Json header = Json::object();
  std::uint64_t offset = 0, hash = Fnv1a64({});
  for (const TensorRecord& record : file.tensors) {
    header[record.name] = {{"dtype", record.dtype},
                           {"shape", record.shape},
                           {"data_offsets", {offset, offset + record.bytes.size()}}};
    offset += record.bytes.size();
    hash = Fnv1a64(record.bytes, hash);
  }
  file.metadata["checksum"] = Hex(hash);
  header["__metadata__"] = file.metadata;
  std::string text = header.dump();
  text.resize((text.size() + 7) / 8 * 8, ' ');  // tensors start at a multiple of eight bytes

  const std::filesystem::path beside = path.string() + ".tmp";
  std::ofstream out(beside, std::ios::binary | std::ios::trunc);
  const std::uint64_t length = text.size();
  out.write(reinterpret_cast<const char*>(&length), sizeof length);
  out.write(text.data(), static_cast<std::streamsize>(text.size()));
  for (const TensorRecord& record : file.tensors) {
    out.write(reinterpret_cast<const char*>(record.bytes.data()),
              static_cast<std::streamsize>(record.bytes.size()));
  }
  out.close();
  if (!out) {
    std::error_code ignored;
    std::filesystem::remove(beside, ignored);
    Fail(path, "file", "a write error", "check free space and permissions of its folder");
  }
  std::filesystem::rename(beside, path);
}

TensorFile ReadTensorFile(const std::filesystem::path& path) {
  const std::vector<std::byte> bytes = ReadAll(path);
  std::uint64_t length = 0;
  if (bytes.size() < sizeof length) Fail(path, "header", std::to_string(bytes.size()) + " bytes");
  std::memcpy(&length, bytes.data(), sizeof length);
  if (length > kMaxHeaderBytes || length > bytes.size() - sizeof length) {
    Fail(path, "header",
         "a length of " + std::to_string(length) + " bytes in a file of " +
             std::to_string(bytes.size()));
  }
  const char* text = reinterpret_cast<const char*>(bytes.data()) + sizeof length;
  const std::span<const std::byte> data = std::span(bytes).subspan(sizeof length + length);
  if (const int depth = JsonDepth({text, length}); depth > kMostJsonDepth) {
    Fail(path, "header", "brackets nested " + std::to_string(depth) + " deep");
  }
  TensorFile file;
  std::size_t held = 0;  // a small file must not become a large one in memory
  try {
    const Json header = Json::parse(text, text + length);
    if (!header.is_object()) Fail(path, "header", "JSON that is not an object");
    for (const auto& [name, entry] : header.items()) {
      if (name == "__metadata__") {
        file.metadata = entry.get<std::map<std::string, std::string>>();
      } else {
        file.tensors.push_back(ReadRecord(path, name, entry, data));
        held += file.tensors.back().bytes.size();
        if (held > data.size()) Fail(path, "tensor " + name, "bytes that overlap another tensor's");
        RequireFinite(path, file.tensors.back());
      }
    }
  } catch (const Json::exception&) {
    Fail(path, "header", "text that is not the header of a safetensors file");
  }
  const auto checksum = file.metadata.find("checksum");
  if (checksum != file.metadata.end() && checksum->second != Hex(Fnv1a64(data))) {
    Fail(path, "checksum", Hex(Fnv1a64(data)) + " where the file says " + checksum->second);
  }
  return file;
}

TensorRecord MakeRecord(const std::string& name, std::vector<std::int64_t> shape,
                        std::span<const float> values, bool as_bf16) {
  TensorRecord record{name, as_bf16 ? "BF16" : "F32", std::move(shape), {}};
  record.bytes.resize(values.size() * (as_bf16 ? 2 : 4));
  if (!as_bf16) {
    std::memcpy(record.bytes.data(), values.data(), record.bytes.size());
    return record;
  }
  for (size_t i = 0; i < values.size(); ++i) {
    std::uint32_t bits = std::bit_cast<std::uint32_t>(values[i]);
    bits += 0x7FFFu + ((bits >> 16) & 1u);
    const std::uint16_t upper = static_cast<std::uint16_t>(bits >> 16);
    std::memcpy(record.bytes.data() + 2 * i, &upper, 2);
  }
  return record;
}

std::vector<float> RecordValues(const TensorRecord& record) {
  if (record.dtype != "F32" && record.dtype != "BF16") {
    throw std::runtime_error("tensor " + record.name + ": found dtype " + record.dtype +
                             "; only F32 and BF16 are read");
  }
  if (record.dtype == "F32") {
    std::vector<float> values(record.bytes.size() / 4);
    std::memcpy(values.data(), record.bytes.data(), record.bytes.size());
    return values;
  }
  std::vector<float> values(record.bytes.size() / 2);
  for (size_t i = 0; i < values.size(); ++i) {
    std::uint16_t upper;
    std::memcpy(&upper, record.bytes.data() + 2 * i, 2);
    values[i] = std::bit_cast<float>(static_cast<std::uint32_t>(upper) << 16);
  }
  return values;
}

}  // namespace glint
