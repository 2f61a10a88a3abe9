#include "base/images/oiio.h"

#include <OpenEXR/ImfHeader.h>
#include <OpenImageIO/filesystem.h>

#include <algorithm>
#include <array>
#include <fstream>
#include <mutex>
#include <optional>
#include <set>

#include "base/files/files.h"
#include "base/files/memory_limit.h"
#include "base/images/exr_rows.h"
#include "base/images/image.h"
#include "base/images/image_format.h"
#include "base/images/jpeg_segments.h"

namespace glint {
namespace {

constexpr int kMostExrSide = 1 << 17;
constexpr std::size_t kMaxJpegBytes = 512u << 20;

// libheif's words where the file is whole and a plug-in is missing.
bool LacksDecoder(const std::string& reason) {
  for (const char* words : {"Unsupported codec", "No decoding plugin", "Unsupported feature"}) {
    if (reason.find(words) != std::string::npos) return true;
  }
  return false;
}

}  // namespace

void RequireMemoryForRows(const std::filesystem::path& file, const OIIO::ImageSpec& spec,
                          int rows) {
  const double needed = static_cast<double>(sizeof(float)) * spec.width * rows * spec.nchannels;
  const auto limit = static_cast<double>(MemoryLimit_bytes());
  if (needed <= limit) return;
  throw UserError(file, "size",
                  std::to_string(spec.width) + "x" + std::to_string(rows) + " pixels of " +
                      std::to_string(spec.nchannels) + " channels, which need " +
                      MemoryText(needed) + " of memory",
                  "Glint may use " + MemoryText(limit) + " here (--memory); scale it down");
}

void RejectUnreadable(const std::filesystem::path& file, std::string reason,
                      const std::string& formats) {
  if (reason.size() > 200) reason.resize(200);
  while (!reason.empty() && reason.back() == '\n') reason.pop_back();
  if (ReaderOf(file) == "heif" &&
      (LacksDecoder(reason) || ("," + formats + ",").find(",heif,") == std::string::npos)) {
    throw EnvironmentError(file.string() +
                           ": found a HEIC or AVIF photograph, for which no decoder is " +
                           "installed (" + reason + "); install libheif1 with libde265-0 and an " +
                           "OpenImageIO built with it, or convert the photographs to JPEG");
  }
  if (IsRawFileName(file)) {
    throw UserError(
        file, "",
        "a RAW file of a camera that LibRaw does not know, or a damaged one (" + reason + ")",
        "convert it to DNG or to 16-bit TIFF, or remove it");
  }
  throw UserError(file, "", "no image that can be read (" + reason + ")",
                  "give a JPEG, PNG, TIFF, EXR, HEIC or RAW file, or remove it");
}

namespace {

int exr_threads = 1;

}  // namespace

void SetExrThreads(int threads) { exr_threads = threads; }

void SetUpOiio() {
  static std::once_flag once;
  std::call_once(once, [] {
    constexpr int kInTheCaller = -1;
    OIIO::attribute("limits:channels", 64);
    OIIO::attribute("limits:imagesize_MB", 16384);  // kMaxPixels are refused before
    OIIO::attribute("threads", 1);
    OIIO::attribute("exr_threads", exr_threads > 1 ? exr_threads : kInTheCaller);
    // OpenEXR makes a table with an entry for every line of an image before anyone sees its size.
    Imf::Header::setMaxImageSize(kMostExrSide, kMostExrSide);
  });
}

namespace {

void RequireFile(const std::filesystem::path& file) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(file, error)) {
    throw UserError(file, "", "no such file", "check the path");
  }
  if (std::filesystem::file_size(file, error) == 0) {
    throw UserError(file, "", "an empty file", "copy the photograph again");
  }
}

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

// OpenEXR and libpng allocate what a length says, up to 2 GiB, before they look for the bytes. What
// a file is called does not matter: its first bytes choose its reader.
void RequireLengthsWithinFile(const std::filesystem::path& file) {
  constexpr std::array<char, 4> kExr = {0x76, 0x2f, 0x31, 0x01};
  constexpr std::array<char, 4> kPng = {static_cast<char>(0x89), 'P', 'N', 'G'};
  std::error_code error;
  const std::uintmax_t size = std::filesystem::file_size(file, error);
  std::ifstream stream(file, std::ios::binary);
  std::array<char, 4> magic = {};
  stream.read(magic.data(), magic.size());
  if (magic == kExr) RequireAttributesWithin(file, size, stream);
  if (magic == kPng) RequireChunksWithin(file, size, stream);
}

void RequireSize(const std::filesystem::path& file, const OIIO::ImageSpec& spec,
                 HowRead how = HowRead::kWhole) {
  if (spec.width < 1 || spec.height < 1 || spec.depth != 1 || spec.nchannels < 1 ||
      static_cast<std::size_t>(spec.width) * static_cast<std::size_t>(spec.height) > kMaxPixels) {
    throw UserError(file, "size",
                    std::to_string(spec.width) + "x" + std::to_string(spec.height) + " pixels",
                    "images of at most " + std::to_string(kMaxPixels >> 20) + " Mpx are read");
  }
  if (how == HowRead::kWhole) RequireMemoryForRows(file, spec, spec.height);
}

// A reader and the bytes it reads, where those are not the file's own.
struct OpenedImage {
  std::string bytes;
  std::optional<OIIO::Filesystem::IOMemReader> memory;
  std::unique_ptr<OIIO::ImageInput> input;  // ends before what it reads
};

void ReadFromMemory(std::string bytes, OpenedImage* image) {
  image->bytes = std::move(bytes);
  image->memory.emplace(image->bytes.data(), image->bytes.size());
  image->input->set_ioproxy(&*image->memory);
}

}  // namespace

std::shared_ptr<OIIO::ImageInput> OpenImage(const std::filesystem::path& file,
                                            const OIIO::ImageSpec* configuration) {
  SetUpOiio();
  RequireFile(file);
  RequireLengthsWithinFile(file);
  const std::string formats = OIIO::get_string_attribute("input_format_list");
  const std::string reader = ReaderOf(file);
  if (reader.empty()) RejectUnreadable(file, "its first bytes match no such format", formats);
  const auto opened = std::make_shared<OpenedImage>();
  std::unique_ptr<OIIO::ImageInput>& input = opened->input;
  input = OIIO::ImageInput::create(reader);
  OIIO::ImageSpec spec;
  if (!input) RejectUnreadable(file, OIIO::geterror(), formats);
  if (reader == "jpeg")
    ReadFromMemory(WithPictureSegmentsAlone(ReadTextFile(file, kMaxJpegBytes)), opened.get());
  if (!input->open(file.string(), spec, configuration ? *configuration : OIIO::ImageSpec())) {
    RejectUnreadable(file, input->geterror(), formats);
  }
  RequireSize(file, input->spec());
  return {opened, input.get()};
}

std::unique_ptr<OIIO::ImageInput> OpenExr(const std::filesystem::path& file, HowRead how) {
  SetUpOiio();
  RequireFile(file);
  RequireLengthsWithinFile(file);
  std::unique_ptr<OIIO::ImageInput> input = OIIO::ImageInput::create("openexr");
  OIIO::ImageSpec spec;
  if (!input || !input->open(file.string(), spec)) {
    std::string reason = input ? input->geterror() : OIIO::geterror();
    if (reason.size() > 200) reason.resize(200);
    throw UserError(file, "format", "no OpenEXR image that can be read (" + reason + ")",
                    "an OpenEXR image is expected here");
  }
  RequireSize(file, spec, how);
  return input;
}

void RejectTruncated(const std::filesystem::path& file, OIIO::ImageInput* input) {
  std::string reason = input->geterror();
  if (reason.size() > 200) reason.resize(200);
  throw UserError(file, "", "an image that ends early or is damaged (" + reason + ")",
                  "copy the photograph again, or remove it");
}

}  // namespace glint
