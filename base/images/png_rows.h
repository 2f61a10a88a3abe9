// PNG files written by rows, so that a large one is never whole in memory.
#pragma once

#include <filesystem>
#include <memory>

#include "base/images/image.h"

namespace glint {

// 8 or 16 bits, 1, 3 or 4 channels, as WritePng makes it: the same bytes, whatever rows are written
// together.
class PngWriter {
 public:
  // Throws EnvironmentError.
  PngWriter(const std::filesystem::path& file, int width, int height, int channels, int bits,
            const PngTags& tags = {});
  ~PngWriter();
  PngWriter(PngWriter&&) noexcept;

  // The next rows, from the top. Values are clamped to [0, 1] and rounded. Throws EnvironmentError,
  // and removes the file: a disk that is full is noticed here or by Close().
  void Write(const Image& rows);
  // After the last row.
  void Close();

 private:
  struct Output;
  void Check(bool well);
  std::filesystem::path file_;
  std::unique_ptr<Output> output_;
};

}  // namespace glint
