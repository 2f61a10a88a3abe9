// OpenImageIO with bounds on what untrusted files may make it allocate. Included by .cc files only.
#pragma once

#include <OpenImageIO/imageio.h>

#include <filesystem>
#include <memory>
#include <vector>

#include "base/errors/errors.h"
#include "base/images/image_bounds.h"

namespace glint {

// Limits on size and channels, one thread inside the library but for EXR (SetExrThreads); done
// once.
void SetUpOiio();

// Opens an image and checks its header. What is returned keeps all that its reader needs. Throws
// UserError: missing, empty, not an image, too large; EnvironmentError: a HEIC file where no
// decoder is installed.
std::shared_ptr<OIIO::ImageInput> OpenImage(const std::filesystem::path& file,
                                            const OIIO::ImageSpec* configuration = nullptr);

// What OpenImage throws for a file that does not open. `reason` is OpenImageIO's own, and `formats`
// the formats it was built with ("bmp,heif,jpeg,…").
[[noreturn]] void RejectUnreadable(const std::filesystem::path& file, std::string reason,
                                   const std::string& formats);

// All samples, interleaved. Throws UserError when the file ends early.
template <class T>
std::vector<T> ReadSamples(const std::filesystem::path& file, OIIO::ImageInput* input,
                           OIIO::TypeDesc type) {
  const OIIO::ImageSpec& spec = input->spec();
  std::vector<T> samples(static_cast<size_t>(spec.width) * spec.height * spec.nchannels);
  if (!input->read_image(0, 0, 0, spec.nchannels, type, samples.data())) {
    RejectTruncated(file, input->geterror());
  }
  return samples;
}

}  // namespace glint
