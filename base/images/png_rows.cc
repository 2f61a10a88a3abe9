#include "base/images/png_rows.h"

#include <png.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <fstream>
#include <stdexcept>
#include <utility>
#include <vector>

#include "base/errors/errors.h"
#include "base/images/image_bounds.h"
#include "base/images/png_encoder.h"

namespace glint {
namespace {

// Values of an image clamped to [0, 1], rounded to 8 or 16 bits, interleaved; most significant byte
// first, as PNG has them.
std::vector<std::uint8_t> SamplesOf(const Image& image, int bits) {
  const size_t channels = image.channels.size(), pixels = image.pixels();
  const size_t bytes = bits == 16 ? 2 : 1;
  const float scale = bits == 16 ? 65535.0f : 255.0f;
  std::vector<std::uint8_t> samples(channels * pixels * bytes);
  for (size_t c = 0; c < channels; ++c) {
    const auto plane = image.channel(static_cast<int>(c));
    for (size_t i = 0; i < pixels; ++i) {
      const float value = std::isfinite(plane[i]) ? std::clamp(plane[i], 0.0f, 1.0f) : 0.0f;
      const auto rounded = static_cast<unsigned>(std::lround(value * scale));
      std::uint8_t* to = samples.data() + (i * channels + c) * bytes;
      if (bits == 16) *to++ = static_cast<std::uint8_t>(rounded >> 8);
      *to = static_cast<std::uint8_t>(rounded & 0xff);
    }
  }
  return samples;
}

std::uint32_t BigEndian(const char* bytes) {
  std::uint32_t value = 0;
  for (int i = 0; i < 4; ++i) value = value << 8 | static_cast<unsigned char>(bytes[i]);
  return value;
}

}  // namespace

ImageHeader ReadPngHeader(const std::filesystem::path& file) {
  // Signature, length and name of IHDR, which comes first; width, height, depth, colours.
  constexpr size_t kWidth = 16, kHeight = 20, kColours = 25, kBytes = 26;
  RequireImageFile(file);
  std::array<char, kBytes> head = {};
  std::ifstream stream(file, std::ios::binary);
  constexpr size_t kSignatureBytes = 8;
  if (!stream.read(head.data(), kBytes) ||
      png_sig_cmp(reinterpret_cast<png_const_bytep>(head.data()), 0, kSignatureBytes) != 0) {
    RejectTruncated(file, "no header of a PNG");
  }
  std::vector<std::string> channels = {"Y"};
  if ((head[kColours] & PNG_COLOR_MASK_COLOR) != 0) channels = kRgbChannels;
  if ((head[kColours] & PNG_COLOR_MASK_ALPHA) != 0) channels.emplace_back("A");
  return {static_cast<int>(BigEndian(head.data() + kWidth)),
          static_cast<int>(BigEndian(head.data() + kHeight)), channels};
}

Image ReadPng(const std::filesystem::path& file) {
  RequireImageFile(file);
  png_image png = {};
  png.version = PNG_IMAGE_VERSION;
  if (png_image_begin_read_from_file(&png, file.c_str()) == 0) RejectTruncated(file, png.message);
  png.format = PNG_FORMAT_RGB;
  // Frees what the header's reader holds, whatever is thrown.
  const std::unique_ptr<png_image, decltype(&png_image_free)> held(&png, &png_image_free);
  const ImageSize size = {static_cast<int>(png.width), static_cast<int>(png.height), 3};
  RequireSize(file, size);
  RequireMemoryForRows(file, size, size.height);
  std::vector<std::uint8_t> samples(PNG_IMAGE_SIZE(png));
  if (png_image_finish_read(&png, nullptr, samples.data(), 0, nullptr) == 0) {
    RejectTruncated(file, png.message);
  }
  Image image(size.width, size.height, kRgbChannels);
  for (int c = 0; c < 3; ++c) {
    const auto plane = image.channel(c);
    for (size_t i = 0; i < plane.size(); ++i) {
      plane[i] = static_cast<float>(samples[3 * i + static_cast<size_t>(c)]) / 255.0f;
    }
  }
  return image;
}

std::string EncodePng(const Image& image, int bits, const PngTags& tags) {
  std::string encoded;
  PngEncoder encoder([&](const char* bytes, size_t size) { encoded.append(bytes, size); });
  if (!encoder.Begin(image.width, image.height, static_cast<int>(image.channels.size()), bits,
                     tags) ||
      !encoder.Write(SamplesOf(image, bits), image.height) || !encoder.End()) {
    throw EnvironmentError("a PNG cannot be encoded: " + encoder.reason());
  }
  return encoded;
}

struct PngWriter::Output {
  Output(const std::filesystem::path& file, int width_in, int height_in, int channels_in,
         int bits_in)
      : stream(file, std::ios::binary),
        encoder([this](const char* bytes, size_t size) {
          stream.write(bytes, static_cast<std::streamsize>(size));
        }),
        width(width_in),
        height(height_in),
        channels(channels_in),
        bits(bits_in) {}
  std::ofstream stream;
  PngEncoder encoder;
  int width, height, channels, bits;
  int next_row = 0;
};

PngWriter::PngWriter(const std::filesystem::path& file, int width, int height, int channels,
                     int bits, const PngTags& tags)
    : file_(file), output_(std::make_unique<Output>(file, width, height, channels, bits)) {
  Check(output_->encoder.Begin(width, height, channels, bits, tags));
}

PngWriter::~PngWriter() = default;
PngWriter::PngWriter(PngWriter&&) noexcept = default;

void PngWriter::Check(bool well) {
  if (well && output_->stream.flush()) return;
  const std::string reason = output_->encoder.reason();
  output_.reset();
  std::error_code error;
  std::filesystem::remove(file_, error);
  throw EnvironmentError(file_.string() + ": cannot write the image" +
                         (reason.empty() ? "" : ": " + reason) +
                         "; check the folder's permissions and the free space");
}

void PngWriter::Write(const Image& rows) {
  if (rows.width != output_->width || static_cast<int>(rows.channels.size()) != output_->channels ||
      output_->next_row + rows.height > output_->height) {
    throw std::invalid_argument("PngWriter: rows of another image");
  }
  output_->next_row += rows.height;
  Check(output_->encoder.Write(SamplesOf(rows, output_->bits), rows.height));
}

void PngWriter::Close() {
  if (output_->next_row != output_->height) throw std::logic_error("PngWriter: rows are missing");
  Check(output_->encoder.End());
  output_->stream.close();
  Check(!output_->stream.fail());
}

}  // namespace glint
