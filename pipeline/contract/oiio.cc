#include "pipeline/contract/oiio.h"

#include <mutex>

#include "pipeline/contract/image.h"

namespace glint {

void SetUpOiio() {
  static std::once_flag once;
  std::call_once(once, [] {
    OIIO::attribute("limits:channels", 64);
    OIIO::attribute("limits:imagesize_MB", 8192);
    OIIO::attribute("threads", 1);
    OIIO::attribute("exr_threads", -1);
  });
}

std::unique_ptr<OIIO::ImageInput> OpenImage(const std::filesystem::path& file,
                                            const OIIO::ImageSpec* configuration) {
  SetUpOiio();
  std::error_code error;
  if (!std::filesystem::is_regular_file(file, error)) {
    throw UserError(file, "", "no such file", "check the path");
  }
  if (std::filesystem::file_size(file, error) == 0) {
    throw UserError(file, "", "an empty file", "copy the photograph again");
  }
  std::unique_ptr<OIIO::ImageInput> input = OIIO::ImageInput::open(file.string(), configuration);
  if (!input) {
    std::string reason = OIIO::geterror();
    if (reason.size() > 200) reason.resize(200);
    throw UserError(file, "", "no image that can be read (" + reason + ")",
                    "give a JPEG, PNG, TIFF, EXR, HEIC or RAW file, or take it out");
  }
  const OIIO::ImageSpec& spec = input->spec();
  if (spec.width < 1 || spec.height < 1 || spec.depth != 1 || spec.nchannels < 1 ||
      static_cast<std::size_t>(spec.width) * static_cast<std::size_t>(spec.height) > kMaxPixels) {
    throw UserError(file, "size",
                    std::to_string(spec.width) + "x" + std::to_string(spec.height) + " pixels",
                    "images of at most " + std::to_string(kMaxPixels >> 20) + " Mpx are read");
  }
  return input;
}

void RejectTruncated(const std::filesystem::path& file, OIIO::ImageInput* input) {
  std::string reason = input->geterror();
  if (reason.size() > 200) reason.resize(200);
  throw UserError(file, "", "an image that ends early or is damaged (" + reason + ")",
                  "copy the photograph again, or take it out");
}

}  // namespace glint
