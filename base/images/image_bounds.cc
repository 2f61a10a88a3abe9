#include "base/images/image_bounds.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <fstream>

#include "base/errors/errors.h"
#include "base/files/memory_limit.h"

namespace glint {
namespace {

[[noreturn]] void RejectLength(const std::filesystem::path& file, const char* what,
                               std::uint32_t length, std::uintmax_t size) {
  throw UserError(file, "header",
                  std::string(what) + " of " + std::to_string(length) + " bytes in a file of " +
                      std::to_string(size),
                  "the file is damaged; copy or make it again");
}

std::uint32_t LittleEndian(const std::array<unsigned char, 4>& b) {
  return b[0] | b[1] << 8 | b[2] << 16 | static_cast<std::uint32_t>(b[3]) << 24;
}

// A list of (name, type, length, bytes) after magic number and version, all lengths of 4 bytes.
void RequireAttributesWithin(const std::filesystem::path& file, std::uintmax_t size,
                             std::istream& stream) {
  constexpr std::size_t kMagicAndVersion = 8, kLongestName = 256;
  stream.seekg(kMagicAndVersion);
  std::string name, type;
  while (std::getline(stream, name, '\0') && !name.empty() && name.size() < kLongestName &&
         std::getline(stream, type, '\0') && type.size() < kLongestName) {
    std::array<unsigned char, 4> bytes = {};
    stream.read(reinterpret_cast<char*>(bytes.data()), bytes.size());
    const std::uint32_t length = LittleEndian(bytes);
    if (stream && length > size) RejectLength(file, "an attribute", length, size);
    stream.seekg(length, std::ios::cur);
  }
}

// A list of (length, type, bytes, checksum) after the signature, big endian.
void RequireChunksWithin(const std::filesystem::path& file, std::uintmax_t size,
                         std::istream& stream) {
  constexpr std::size_t kSignature = 8, kTypeAndChecksum = 8;
  stream.seekg(kSignature);
  std::array<unsigned char, 4> bytes = {};
  while (stream.read(reinterpret_cast<char*>(bytes.data()), bytes.size())) {
    std::reverse(bytes.begin(), bytes.end());
    const std::uint32_t length = LittleEndian(bytes);
    if (length > size) RejectLength(file, "a chunk", length, size);
    stream.seekg(length + kTypeAndChecksum, std::ios::cur);
  }
}

}  // namespace

void RequireImageFile(const std::filesystem::path& file) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(file, error)) {
    throw UserError(file, "", "no such file", "check the path");
  }
  const std::uintmax_t size = std::filesystem::file_size(file, error);
  if (size == 0) throw UserError(file, "", "an empty file", "copy the photograph again");
  constexpr std::array<char, 4> kExr = {0x76, 0x2f, 0x31, 0x01};
  constexpr std::array<char, 4> kPng = {static_cast<char>(0x89), 'P', 'N', 'G'};
  std::ifstream stream(file, std::ios::binary);
  std::array<char, 4> magic = {};
  stream.read(magic.data(), magic.size());
  if (magic == kExr) RequireAttributesWithin(file, size, stream);
  if (magic == kPng) RequireChunksWithin(file, size, stream);
}

void RequireSize(const std::filesystem::path& file, const ImageSize& size) {
  if (size.width < 1 || size.height < 1 || size.channels < 1 ||
      static_cast<std::size_t>(size.width) * static_cast<std::size_t>(size.height) > kMaxPixels) {
    throw UserError(file, "size",
                    std::to_string(size.width) + "x" + std::to_string(size.height) + " pixels",
                    "images of at most " + std::to_string(kMaxPixels >> 20) + " Mpx are read");
  }
  if (size.channels > kMaxImageChannels) {
    throw UserError(file, "channels", std::to_string(size.channels),
                    "at most " + std::to_string(kMaxImageChannels) + " are read");
  }
}

void RequireMemoryForRows(const std::filesystem::path& file, const ImageSize& size, int rows) {
  const double needed = static_cast<double>(sizeof(float)) * size.width * rows * size.channels;
  const auto limit = static_cast<double>(MemoryLimit_bytes());
  if (needed <= limit) return;
  throw UserError(file, "size",
                  std::to_string(size.width) + "x" + std::to_string(rows) + " pixels of " +
                      std::to_string(size.channels) + " channels, which need " +
                      MemoryText(needed) + " of memory",
                  "Glint may use " + MemoryText(limit) + " here (--memory); scale it down");
}

void RejectTruncated(const std::filesystem::path& file, std::string reason) {
  if (reason.size() > 200) reason.resize(200);
  throw UserError(file, "", "an image that ends early or is damaged (" + reason + ")",
                  "copy the photograph again, or remove it");
}

}  // namespace glint
