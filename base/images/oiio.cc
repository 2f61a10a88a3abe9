#include "base/images/oiio.h"

#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfThreading.h>
#include <OpenImageIO/filesystem.h>

#include <mutex>
#include <optional>

#include "base/files/files.h"
#include "base/images/image.h"
#include "base/images/image_bounds.h"
#include "base/images/image_format.h"
#include "base/images/jpeg_segments.h"

namespace glint {
namespace {

constexpr std::size_t kMaxJpegBytes = 512u << 20;

// libheif's words where the file is whole and a plug-in is missing.
bool LacksDecoder(const std::string& reason) {
  for (const char* words : {"Unsupported codec", "No decoding plugin", "Unsupported feature"}) {
    if (reason.find(words) != std::string::npos) return true;
  }
  return false;
}

}  // namespace

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

void SetUpOiio() {
  static std::once_flag once;
  std::call_once(once, [] {
    OIIO::attribute("limits:channels", kMaxImageChannels);
    OIIO::attribute("limits:imagesize_MB", 16384);  // kMaxPixels are refused before
    OIIO::attribute("threads", 1);
    constexpr int kInTheCaller = -1;
    const int exr_threads = Imf::globalThreadCount();  // SetExrThreads()
    OIIO::attribute("exr_threads", exr_threads > 1 ? exr_threads : kInTheCaller);
    Imf::Header::setMaxImageSize(kMostExrSide_px, kMostExrSide_px);
  });
}

namespace {

ImageSize SizeOf(const OIIO::ImageSpec& spec) {
  // Of no depth: nothing that is a picture.
  return {spec.width, spec.depth == 1 ? spec.height : 0, spec.nchannels};
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
  RequireImageFile(file);
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
  RequireSize(file, SizeOf(input->spec()));
  RequireMemoryForRows(file, SizeOf(input->spec()), input->spec().height);
  return {opened, input.get()};
}

ImageHeader ReadImageHeader(const std::filesystem::path& file) {
  const auto input = OpenImage(file);
  const OIIO::ImageSpec& spec = input->spec();
  return {spec.width, spec.height, spec.channelnames};
}

}  // namespace glint
