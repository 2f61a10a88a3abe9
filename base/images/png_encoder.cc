#include "base/images/png_encoder.h"

#include <zlib.h>

#include <algorithm>
#include <cmath>
#include <csetjmp>
#include <new>
#include <utility>

namespace glint {

PngEncoder::PngEncoder(Sink sink)
    : sink_(std::move(sink)),
      png_(png_create_write_struct(PNG_LIBPNG_VER_STRING, this, &PngEncoder::Failed, nullptr)) {
  if (png_ == nullptr) throw std::bad_alloc();
  info_ = png_create_info_struct(png_);
  if (info_ == nullptr) {
    png_destroy_write_struct(&png_, nullptr);
    throw std::bad_alloc();
  }
  png_set_write_fn(png_, this, &PngEncoder::Written, nullptr);
}

PngEncoder::~PngEncoder() { png_destroy_write_struct(&png_, &info_); }

void PngEncoder::Failed(png_structp png, png_const_charp reason) {
  static_cast<PngEncoder*>(png_get_error_ptr(png))->reason_ = reason;
  png_longjmp(png, 1);
}

void PngEncoder::Written(png_structp png, png_bytep bytes, size_t size) {
  static_cast<PngEncoder*>(png_get_io_ptr(png))->sink_(reinterpret_cast<char*>(bytes), size);
}

// libpng leaves its functions by longjmp() where it fails: nothing between may have a destructor.

bool PngEncoder::Begin(int width, int height, int channels, int bits, const PngTags& tags) {
  if (setjmp(png_jmpbuf(png_)) != 0) return false;
  constexpr int kColours[] = {PNG_COLOR_TYPE_GRAY, PNG_COLOR_TYPE_GRAY_ALPHA, PNG_COLOR_TYPE_RGB,
                              PNG_COLOR_TYPE_RGBA};
  png_set_IHDR(png_, info_, static_cast<png_uint_32>(width), static_cast<png_uint_32>(height), bits,
               kColours[std::clamp(channels, 1, 4) - 1], PNG_INTERLACE_NONE,
               PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
  // Maps and photographs hold noise, in which little repeats but what lies side by side. Compared
  // with zlib's search for repeats anywhere, maps are written eight times as fast and are at most
  // an eighth larger.
  png_set_compression_strategy(png_, Z_RLE);
  png_set_filter(png_, PNG_FILTER_TYPE_BASE, PNG_FILTER_AVG);
  if (tags.transfer == PngTransfer::kSrgb) {
    png_set_sRGB_gAMA_and_cHRM(png_, info_, PNG_sRGB_INTENT_ABSOLUTE);
  }
  if (tags.pixels_per_m > 0) {
    const auto per_m = static_cast<png_uint_32>(std::lround(tags.pixels_per_m));
    png_set_pHYs(png_, info_, per_m, per_m, PNG_RESOLUTION_METER);
  }
  png_write_info(png_, info_);
  return true;
}

bool PngEncoder::Write(const std::vector<std::uint8_t>& samples, int rows) {
  if (setjmp(png_jmpbuf(png_)) != 0) return false;
  const size_t row_bytes = samples.size() / static_cast<size_t>(rows);
  for (int row = 0; row < rows; ++row) {
    png_write_row(png_, samples.data() + static_cast<size_t>(row) * row_bytes);
  }
  return true;
}

bool PngEncoder::End() {
  if (setjmp(png_jmpbuf(png_)) != 0) return false;
  png_write_end(png_, nullptr);
  return true;
}

}  // namespace glint
