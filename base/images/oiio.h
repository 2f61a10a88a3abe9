// OpenImageIO with bounds on what untrusted files may make it allocate. Included by .cc files only.
#pragma once

#include <OpenImageIO/imageio.h>

#include <filesystem>
#include <memory>
#include <vector>

#include "base/errors/errors.h"

namespace glint {

// Limits on size and channels, one thread inside the library but for EXR (SetExrThreads); done
// once.
void SetUpOiio();

// Opens an image and checks its header. What is returned keeps all that its reader needs. Throws
// UserError: missing, empty, not an image, too large; EnvironmentError: a HEIC file where no
// decoder is installed.
std::shared_ptr<OIIO::ImageInput> OpenImage(const std::filesystem::path& file,
                                            const OIIO::ImageSpec* configuration = nullptr);

// The same for OpenEXR alone: no other format's reader looks at the file, which some allocate
// gigabytes for. What is read by rows need not fit into memory.
enum class HowRead { kWhole, kByRows };
std::unique_ptr<OIIO::ImageInput> OpenExr(const std::filesystem::path& file,
                                          HowRead how = HowRead::kWhole);
// Throws UserError where so many rows need more memory than allowed: a small file may ask for a
// large image.
void RequireMemoryForRows(const std::filesystem::path& file, const OIIO::ImageSpec& spec, int rows);

// A fixed date keeps the library from writing the present one.
inline constexpr char kNoDate[] = "1970:01:01 00:00:00";

// What OpenImage throws for a file that does not open. `reason` is OpenImageIO's own, and `formats`
// the formats it was built with ("bmp,heif,jpeg,…").
[[noreturn]] void RejectUnreadable(const std::filesystem::path& file, std::string reason,
                                   const std::string& formats);

[[noreturn]] void RejectTruncated(const std::filesystem::path& file, OIIO::ImageInput* input);

// All samples, interleaved. Throws UserError when the file ends early.
template <class T>
std::vector<T> ReadSamples(const std::filesystem::path& file, OIIO::ImageInput* input,
                           OIIO::TypeDesc type) {
  const OIIO::ImageSpec& spec = input->spec();
  std::vector<T> samples(static_cast<size_t>(spec.width) * spec.height * spec.nchannels);
  if (!input->read_image(0, 0, 0, spec.nchannels, type, samples.data())) {
    RejectTruncated(file, input);
  }
  return samples;
}

}  // namespace glint
