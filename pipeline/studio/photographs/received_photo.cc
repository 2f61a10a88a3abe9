#include "pipeline/studio/photographs/received_photo.h"

#include <fcntl.h>
#include <stdio.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cerrno>
#include <cstring>

#include "base/errors/errors.h"
#include "base/files/files.h"
#include "base/files/hash.h"
#include "base/images/image_format.h"
#include "base/photos/jpeg_end.h"
#include "base/photos/photo_header.h"
#include "pipeline/studio/access/token.h"
#include "pipeline/studio/http/http_types.h"

namespace glint {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kFirst_bytes = 32;
constexpr char kTemporaryPrefix[] = ".upload-";
// The largest sensors of phones have 200 megapixels.
constexpr std::int64_t kMostPhoto_px = 256'000'000;

using Bytes = std::string_view;
using namespace std::string_view_literals;

bool IsOneOf(Bytes text, std::initializer_list<Bytes> list) {
  return std::find(list.begin(), list.end(), text) != list.end();
}

std::string LowerEnding(const std::string& name) {
  std::string ending = fs::path(name).extension().string();
  for (char& c : ending) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return ending;
}

std::string EndingOfBrand(Bytes brand) {
  if (IsOneOf(brand, {"heic", "heix", "heim", "heis", "hevc", "hevx", "mif1", "msf1"})) {
    return ".heic";
  }
  if (IsOneOf(brand, {"avif", "avis"})) return ".avif";
  if (brand == "crx ") return ".cr3";
  return "";
}

[[noreturn]] void ThrowDisk(int error) {
  if (error == ENOSPC || error == EDQUOT) {
    throw HttpError{507, "the disk is full", "make room on it, then send the photograph again"};
  }
  throw HttpError{500, std::string("the photograph cannot be written: ") + std::strerror(error),
                  "make the capture's folder writable"};
}

HttpError NoPhotograph(const std::string& what) {
  return {415, "found " + what, "send a photograph: JPEG, HEIC, PNG, TIFF, WebP, AVIF or RAW"};
}

}  // namespace

std::string PhotoEnding(Bytes first, const std::string& name) {
  if (first.starts_with("\xff\xd8\xff"sv)) return ".jpg";
  if (first.starts_with("\x89PNG\r\n\x1a\n"sv)) return ".png";
  if (first.size() >= 12 && first.starts_with("RIFF"sv) && first.substr(8, 4) == "WEBP")
    return ".webp";
  if (first.starts_with("\x76\x2f\x31\x01"sv)) return ".exr";
  if (first.size() >= 12 && first.substr(4, 4) == "ftyp") return EndingOfBrand(first.substr(8, 4));
  if (first.starts_with("FUJIFILMCCD-RAW"sv)) return ".raf";
  if (first.starts_with("IIU\0"sv)) return ".rw2";
  if (first.starts_with("IIRO"sv) || first.starts_with("IIRS"sv)) return ".orf";
  if (first.starts_with("II*\0"sv) || first.starts_with("MM\0*"sv)) {
    return IsRawFileName(name) ? LowerEnding(name) : ".tif";
  }
  return "";
}

std::string PlainStem(const std::string& client_name) {
  constexpr size_t kMost = 80;
  const size_t slash = client_name.find_last_of("/\\");
  std::string name = slash == std::string::npos ? client_name : client_name.substr(slash + 1);
  name = name.substr(0, name.find_last_of('.') == 0 ? name.size() : name.find_last_of('.'));
  if (name.find_first_not_of("._-") == std::string::npos) return "photograph";
  return FileNameOf(name).substr(0, kMost);
}

ReceivedPhoto::ReceivedPhoto(fs::path folder, std::string client_name)
    : folder_(std::move(folder)), client_name_(std::move(client_name)) {
  std::error_code error;
  fs::create_directories(folder_, error);
}

ReceivedPhoto::~ReceivedPhoto() {
  if (descriptor_ >= 0) ::close(descriptor_);
  if (!temporary_.empty()) ::unlink(temporary_.c_str());
}

void ReceivedPhoto::Identify() {
  ending_ = PhotoEnding(first_bytes_, client_name_);
  if (ending_.empty()) {
    const bool video = first_bytes_.size() >= 12 && Bytes(first_bytes_).substr(4, 4) == "ftyp";
    throw NoPhotograph(video ? "a video" : "a file that is no photograph by its content");
  }
  temporary_ = folder_ / (kTemporaryPrefix + RandomToken() + ending_);
  descriptor_ =
      ::open(temporary_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC | O_NOFOLLOW, 0666);
  if (descriptor_ < 0) {
    temporary_.clear();
    ThrowDisk(errno);
  }
  Write(first_bytes_);
}

void ReceivedPhoto::Write(Bytes bytes) {
  while (!bytes.empty()) {
    const ssize_t count = ::write(descriptor_, bytes.data(), bytes.size());
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) ThrowDisk(errno);
    bytes.remove_prefix(static_cast<size_t>(count));
  }
}

void ReceivedPhoto::Append(Bytes bytes) {
  size_ += bytes.size();
  if (size_ > kMostPhoto_bytes) {
    throw HttpError{413, "the file is larger than 200 MB",
                    "send a smaller one: JPEG or HEIC of the same photograph"};
  }
  if (descriptor_ >= 0) return Write(bytes);
  first_bytes_ += bytes;
  if (first_bytes_.size() >= kFirst_bytes) Identify();
}

std::string ReceivedPhoto::Finish() {
  if (size_ == 0) throw HttpError{415, "found an empty file", "send the photograph again"};
  if (descriptor_ < 0) Identify();
  if (::fsync(descriptor_) != 0) ThrowDisk(errno);
  PhotoHeader header;
  try {
    header = ReadPhotoHeader(temporary_);
  } catch (const std::exception&) {
    throw NoPhotograph("a damaged file, or one that is no photograph");
  }
  const std::int64_t pixels = static_cast<std::int64_t>(header.stored_width) * header.stored_height;
  if (pixels > kMostPhoto_px) {
    throw HttpError{413, "the photograph has more than 256 megapixels", "send a smaller one"};
  }
  if (header.is_jpeg && !JpegIsComplete(ReadTextFile(temporary_, kMostPhoto_bytes + 1))) {
    throw HttpError{400, "the photograph is truncated", "send it again"};
  }
  return HashFile(temporary_);
}

fs::path ReceivedPhoto::Keep() {
  const std::string stem = PlainStem(client_name_);
  constexpr int kMostOfAName = 10000;
  for (int attempt = 1; attempt < kMostOfAName; ++attempt) {
    const std::string number = attempt == 1 ? "" : "-" + std::to_string(attempt);
    fs::path file = folder_ / (stem + number + ending_);
    if (::renameat2(AT_FDCWD, temporary_.c_str(), AT_FDCWD, file.c_str(), RENAME_NOREPLACE) == 0) {
      temporary_.clear();
      const int folder = ::open(folder_.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
      if (folder >= 0) {
        ::fsync(folder);
        ::close(folder);
      }
      return file;
    }
    if (errno != EEXIST) ThrowDisk(errno);
  }
  throw HttpError{409, "too many photographs of this name", "rename the photograph"};
}

void ReceivedPhoto::RemoveLeftovers(const fs::path& folder) {
  std::error_code error;
  std::vector<fs::path> leftovers;
  for (const auto& entry : fs::directory_iterator(folder, error)) {
    if (entry.path().filename().string().starts_with(kTemporaryPrefix)) {
      leftovers.push_back(entry.path());
    }
  }
  for (const fs::path& file : leftovers) fs::remove(file, error);
}

}  // namespace glint
