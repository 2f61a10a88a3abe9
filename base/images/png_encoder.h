// A PNG's bytes, row by row, by libpng. Included by .cc files only.
#pragma once

#include <png.h>

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "base/images/image.h"

namespace glint {

class PngEncoder {
 public:
  // Takes the bytes as they are made.
  using Sink = std::function<void(const char* bytes, size_t size)>;
  explicit PngEncoder(Sink sink);
  ~PngEncoder();
  PngEncoder(const PngEncoder&) = delete;
  PngEncoder& operator=(const PngEncoder&) = delete;

  // One to four channels of 8 or 16 bits. Of these three, false: it failed, for that reason.
  bool Begin(int width, int height, int channels, int bits, const PngTags& tags);
  // The next rows' samples, interleaved, most significant byte first.
  bool Write(const std::vector<std::uint8_t>& samples, int rows);
  bool End();
  const std::string& reason() const { return reason_; }

 private:
  [[noreturn]] static void Failed(png_structp png, png_const_charp reason);
  static void Written(png_structp png, png_bytep bytes, size_t size);

  Sink sink_;
  std::string reason_;
  png_structp png_;
  png_infop info_ = nullptr;
};

}  // namespace glint
