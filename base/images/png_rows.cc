#include "base/images/png_rows.h"

#include <OpenImageIO/filesystem.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <stdexcept>
#include <utility>

#include "base/errors/errors.h"
#include "base/images/oiio.h"
#include "base/images/png_samples.h"

namespace glint {

OIIO::ImageSpec PngSpec(int width, int height, int channels, int bits, const PngTags& tags) {
  OIIO::ImageSpec spec(width, height, channels, bits == 16 ? OIIO::TypeUInt16 : OIIO::TypeUInt8);
  spec.attribute("DateTime", kNoDate);
  // Maps and photographs hold noise, in which little repeats but what lies side by side. Compared
  // with zlib's search for repeats anywhere, maps are written eight times as fast and are at most
  // an eighth larger.
  constexpr int kAverageFilter = 64;  // libpng's PNG_FILTER_AVG
  spec.attribute("compression", "rle");
  spec.attribute("png:filter", kAverageFilter);
  if (tags.transfer == PngTransfer::kSrgb) spec.attribute("oiio:ColorSpace", "sRGB");
  if (tags.pixels_per_m > 0) {
    spec.attribute("XResolution", static_cast<float>(tags.pixels_per_m / 100));
    spec.attribute("YResolution", static_cast<float>(tags.pixels_per_m / 100));
    spec.attribute("ResolutionUnit", "cm");
  }
  return spec;
}

PngSamples::PngSamples(const Image& image, int bits) : bits_(bits) {
  const size_t channels = image.channels.size(), pixels = image.pixels();
  const float scale = bits == 16 ? 65535.0f : 255.0f;
  (bits == 16 ? words_.resize(channels * pixels) : bytes_.resize(channels * pixels));
  for (size_t c = 0; c < channels; ++c) {
    const auto plane = image.channel(static_cast<int>(c));
    for (size_t i = 0; i < pixels; ++i) {
      const float value = std::isfinite(plane[i]) ? std::clamp(plane[i], 0.0f, 1.0f) : 0.0f;
      const auto rounded = std::lround(value * scale);
      if (bits == 16) {
        words_[i * channels + c] = static_cast<std::uint16_t>(rounded);
      } else {
        bytes_[i * channels + c] = static_cast<std::uint8_t>(rounded);
      }
    }
  }
}

struct PngWriter::Output {
  // A file that remembers what went wrong: libpng's writer does not say when the disk is full.
  class CheckedFile : public OIIO::Filesystem::IOProxy {
   public:
    explicit CheckedFile(const std::filesystem::path& file)
        : IOProxy(file.string(), IOProxy::Write), stream_(file, std::ios::binary) {}
    const char* proxytype() const override { return "checked"; }
    size_t write(const void* bytes, size_t size) override {
      stream_.write(static_cast<const char*>(bytes), static_cast<std::streamsize>(size));
      m_pos += static_cast<std::int64_t>(size);
      return size;
    }
    bool well() { return static_cast<bool>(stream_.flush()); }
    bool Finish() {
      stream_.close();
      return !stream_.fail();
    }

   private:
    std::ofstream stream_;
  };

  CheckedFile file;
  std::unique_ptr<OIIO::ImageOutput> image;
  int width, height, channels, bits;
  int next_row = 0;
};

PngWriter::PngWriter(const std::filesystem::path& file, int width, int height, int channels,
                     int bits, const PngTags& tags)
    : file_(file) {
  SetUpOiio();
  output_.reset(new Output{Output::CheckedFile(file), nullptr, width, height, channels, bits});
  output_->image = OIIO::ImageOutput::create("rows.png", &output_->file);
  Check(output_->image && output_->file.well() &&
        output_->image->open("rows.png", PngSpec(width, height, channels, bits, tags)));
}

PngWriter::~PngWriter() = default;
PngWriter::PngWriter(PngWriter&&) noexcept = default;

void PngWriter::Check(bool well) {
  if (well && output_->file.well()) return;
  const std::string reason = output_->image ? output_->image->geterror() : OIIO::geterror();
  output_->image.reset();
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
  const PngSamples samples(rows, output_->bits);
  const int first = output_->next_row;
  output_->next_row += rows.height;
  Check(
      output_->image->write_scanlines(first, output_->next_row, 0, samples.type(), samples.data()));
}

void PngWriter::Close() {
  if (output_->next_row != output_->height) throw std::logic_error("PngWriter: rows are missing");
  Check(output_->image->close());
  Check(output_->file.Finish());
}

}  // namespace glint
