#include "base/images/image_format.h"

#include <algorithm>
#include <array>
#include <fstream>
#include <string_view>
#include <vector>

#include "base/text/file_ending.h"

namespace glint {
namespace {

using Head = std::string_view;  // a file's first bytes, at most kHeadBytes
constexpr std::size_t kHeadBytes = 12;

struct ImageFormat {
  const char* reader;  // of OpenImageIO
  std::vector<const char*> photo_endings;
  bool (*begins)(Head head);
};

bool BeginsIsoMedia(Head head, std::initializer_list<Head> brands) {
  return head.size() >= 12 && head.substr(4, 4) == "ftyp" &&
         std::find(brands.begin(), brands.end(), head.substr(8, 4)) != brands.end();
}

const std::vector<ImageFormat>& ImageFormats() {
  using namespace std::string_view_literals;
  static const std::vector<ImageFormat> formats = {
      {"jpeg", {".jpg", ".jpeg"}, [](Head head) { return head.starts_with("\xff\xd8\xff"sv); }},
      {"png", {".png"}, [](Head head) { return head.starts_with("\x89PNG\r\n"sv); }},
      {"tiff",
       {".tif", ".tiff"},
       [](Head head) {
         return head.starts_with("II*\0"sv) || head.starts_with("MM\0*"sv) ||
                head.starts_with("II+\0"sv) || head.starts_with("MM\0+"sv);
       }},
      {"openexr", {".exr"}, [](Head head) { return head.starts_with("\x76\x2f\x31\x01"sv); }},
      {"heif",
       {".heic", ".heif", ".hif", ".avif"},
       [](Head head) {
         return BeginsIsoMedia(head, {"heic", "heix", "heim", "heis", "hevc", "hevx", "hevm",
                                      "hevs", "mif1", "msf1", "avif", "avis"});
       }},
      {"webp",
       {".webp"},
       [](Head head) {
         return head.size() >= 12 && head.starts_with("RIFF"sv) && head.substr(8, 4) == "WEBP";
       }},
      {"hdr", {}, [](Head head) { return head.starts_with("#?"sv); }},
      {"pnm", {}, [](Head head) { return head.starts_with("P5"sv) || head.starts_with("P6"sv); }},
  };
  return formats;
}

// All that LibRaw may read: a RAW file that is taken for the TIFF file it begins as would give its
// preview.
constexpr std::array kRawEndings = {
    ".3fr", ".ari", ".arw", ".bay", ".cap", ".cine", ".cr2", ".cr3", ".crw", ".cs1", ".dc2",
    ".dcr", ".dng", ".drf", ".dsc", ".erf", ".fff",  ".ia",  ".iiq", ".k25", ".kc2", ".kdc",
    ".mdc", ".mef", ".mos", ".mrw", ".nef", ".nrw",  ".orf", ".pef", ".ptx", ".pxn", ".qtk",
    ".raf", ".raw", ".rdc", ".rw2", ".rwl", ".rwz",  ".sr2", ".srf", ".srw", ".sti", ".x3f"};

}  // namespace

std::string ReaderOf(const std::filesystem::path& file) {
  std::string head(kHeadBytes, '\0');
  std::ifstream stream(file, std::ios::binary);
  stream.read(head.data(), kHeadBytes);
  head.resize(static_cast<std::size_t>(stream.gcount()));
  std::string reader;
  for (const ImageFormat& format : ImageFormats()) {
    if (format.begins(head)) reader = format.reader;
  }
  const bool may_be_raw = reader.empty() || reader == "tiff";
  return may_be_raw && IsRawFileName(file) ? "raw" : reader;
}

bool IsPhotoFileName(const std::filesystem::path& file) {
  return IsRawFileName(file) ||
         std::any_of(ImageFormats().begin(), ImageFormats().end(), [&](const ImageFormat& format) {
           return HasEnding(file, format.photo_endings);
         });
}

bool IsRawFileName(const std::filesystem::path& file) { return HasEnding(file, kRawEndings); }

}  // namespace glint
