#include "base/images/exr_rows.h"

#include <ImathBox.h>
#include <ImathVec.h>
#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfChromaticities.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfIO.h>
#include <OpenEXR/ImfInputFile.h>
#include <OpenEXR/ImfOutputFile.h>
#include <OpenEXR/ImfStandardAttributes.h>
#include <OpenEXR/ImfStringAttribute.h>
#include <OpenEXR/ImfThreading.h>
#include <OpenEXR/ImfTileDescription.h>
#include <half.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <mutex>
#include <stdexcept>
#include <string_view>
#include <tuple>

#include "base/errors/errors.h"
#include "base/images/image_bounds.h"
#include "base/resampling/resampling.h"

namespace glint {
namespace {

constexpr std::string_view kPrefix = "glint:";
// As many rows are made half floats at a time: a multiple of the 32 that are compressed together.
constexpr int kConvertedRows = 64;
constexpr float kLargestHalf = 65504;

void BoundSides() {
  static std::once_flag once;
  std::call_once(once, [] { Imf::Header::setMaxImageSize(kMostExrSide_px, kMostExrSide_px); });
}

// A file knows its channels by the alphabet; a layer's are red, green, blue and alpha.
std::tuple<std::string, size_t, std::string> PlaceOf(const std::string& channel) {
  constexpr std::string_view kColours = "RGBA";
  const size_t dot = channel.rfind('.');
  const bool in_layer = dot != std::string::npos;
  const std::string layer = in_layer ? channel.substr(0, dot) : "";
  const std::string name = in_layer ? channel.substr(dot + 1) : channel;
  const size_t colour = name.size() == 1 ? kColours.find(name) : std::string_view::npos;
  return {layer, std::min(colour, kColours.size()), name};
}

std::vector<std::string> ChannelsOf(const Imf::Header& header) {
  std::vector<std::string> channels;
  for (auto c = header.channels().begin(); c != header.channels().end(); ++c) {
    channels.emplace_back(c.name());
  }
  std::sort(channels.begin(), channels.end(),
            [](const std::string& a, const std::string& b) { return PlaceOf(a) < PlaceOf(b); });
  return channels;
}

// OpenEXR holds a whole row of tiles, however few rows are asked for.
int RowsInMemory(const Imf::Header& header, int rows) {
  if (!header.hasTileDescription()) return rows;
  const unsigned most = std::min(header.tileDescription().ySize, 1u << 30);
  return std::max(rows, static_cast<int>(most));
}

}  // namespace

void SetExrThreads(int threads) { Imf::setGlobalThreadCount(threads > 1 ? threads : 0); }

struct ExrReader::Input {
  explicit Input(const std::filesystem::path& name) : file(name.c_str()) {}
  Imf::InputFile file;
  ImageSize size;
};

ExrReader::ExrReader(const std::filesystem::path& file) : file_(file) {
  BoundSides();
  RequireImageFile(file);
  try {
    input_ = std::make_unique<Input>(file);
  } catch (const std::exception& error) {
    throw UserError(
        file, "format",
        "no OpenEXR image that can be read (" + std::string(error.what()).substr(0, 200) + ")",
        "an OpenEXR image is expected here");
  }
  const Imf::Header& header = input_->file.header();
  channels_ = ChannelsOf(header);
  const Imath::Box2i& window = header.dataWindow();
  input_->size = {window.max.x - window.min.x + 1, window.max.y - window.min.y + 1,
                  static_cast<int>(channels_.size())};
  RequireSize(file, input_->size);
  for (auto a = header.begin(); a != header.end(); ++a) {
    const std::string_view name = a.name();
    const auto* text = dynamic_cast<const Imf::StringAttribute*>(&a.attribute());
    if (text == nullptr || !name.starts_with(kPrefix)) continue;
    attributes_.emplace(name.substr(kPrefix.size()), text->value());
  }
}

ExrReader::~ExrReader() = default;
ExrReader::ExrReader(ExrReader&&) noexcept = default;

int ExrReader::width() const { return input_->size.width; }
int ExrReader::height() const { return input_->size.height; }
ExrPrecision ExrReader::precision() const {
  const Imf::ChannelList& channels = input_->file.header().channels();
  for (auto c = channels.begin(); c != channels.end(); ++c) {
    if (c.channel().type != Imf::HALF) return ExrPrecision::kFloat;
  }
  return ExrPrecision::kHalf;
}

Image ExrReader::Read(int first_row, int rows) {
  const ImageSize& size = input_->size;
  if (first_row < 0 || rows < 1 || first_row + rows > size.height) {
    throw std::invalid_argument("ExrReader: rows outside of the image");
  }
  RequireMemoryForRows(file_, size, RowsInMemory(input_->file.header(), rows));
  Image image(size.width, rows, channels_);
  const Imath::Box2i& window = input_->file.header().dataWindow();
  const int top = window.min.y + first_row;
  Imf::FrameBuffer planes;
  for (size_t c = 0; c < channels_.size(); ++c) {
    planes.insert(channels_[c],
                  Imf::Slice::Make(Imf::FLOAT, image.channel(static_cast<int>(c)).data(),
                                   Imath::V2i(window.min.x, top), size.width, rows));
  }
  try {
    input_->file.setFrameBuffer(planes);
    input_->file.readPixels(top, top + rows - 1);
  } catch (const std::exception& error) {
    RejectTruncated(file_, error.what());
  }
  return image;
}

Image ReadExrAveraged(const std::filesystem::path& file, const std::vector<std::string>& channels,
                      int width, int height) {
  constexpr int kMostInputRows = 256;
  ExrReader reader(file);
  std::vector<int> chosen;
  for (const std::string& name : channels) {
    const auto found = std::find(reader.channels().begin(), reader.channels().end(), name);
    if (found == reader.channels().end()) {
      throw UserError(file, name, "no such channel", "make the file again");
    }
    chosen.push_back(static_cast<int>(found - reader.channels().begin()));
  }
  Image small(width, height, channels);
  const std::vector<Taps> across = AreaTaps(reader.width(), width);
  const std::vector<Taps> down = AreaTaps(reader.height(), height);
  for (const TapGroup& group : GroupTaps(down, kMostInputRows)) {
    const Image rows = reader.Read(group.first_input, group.inputs);
    for (size_t c = 0; c < chosen.size(); ++c) {
      PutRows(ResamplePlanes(rows.channel(chosen[c]), rows.width, rows.height, across, group.taps),
              width, height, group.first_output, small.channel(static_cast<int>(c)));
    }
  }
  return small;
}

struct ExrWriter::Output {
  // A file that remembers what went wrong: OpenEXR's own does not say when the disk is full as the
  // last bytes are written.
  class CheckedFile : public Imf::OStream {
   public:
    explicit CheckedFile(const std::filesystem::path& file)
        : OStream(file.c_str()), stream_(file, std::ios::binary) {}
    void write(const char bytes[], int size) override { stream_.write(bytes, size); }
    std::uint64_t tellp() override { return static_cast<std::uint64_t>(stream_.tellp()); }
    void seekp(std::uint64_t position) override {
      stream_.seekp(static_cast<std::streamoff>(position));
    }
    bool well() const { return !stream_.fail(); }
    bool Close() {
      stream_.close();
      return well();
    }

   private:
    std::ofstream stream_;
  };

  explicit Output(const std::filesystem::path& name) : stream(name) {}
  CheckedFile stream;
  std::unique_ptr<Imf::OutputFile> file;
  int width = 0, height = 0;
  std::vector<std::string> channels;
  ExrPrecision precision = ExrPrecision::kFloat;
};

ExrWriter::ExrWriter(const std::filesystem::path& file, int width, int height,
                     const std::vector<std::string>& channels,
                     const std::map<std::string, std::string>& attributes, ExrPrecision precision)
    : file_(file) {
  errno = 0;
  output_ = std::make_unique<Output>(file);
  output_->width = width;
  output_->height = height;
  output_->channels = channels;
  output_->precision = precision;
  if (!output_->stream.well()) Fail(std::strerror(errno));
  // Wavelets: beside "zip" a fifth smaller and written in half the time where maps are floats, as
  // small and written six times as fast where views are half floats (docs/experiments/run-time.md).
  Imf::Header header(width, height, 1, {0, 0}, 1, Imf::INCREASING_Y, Imf::PIZ_COMPRESSION);
  // Rec.709 primaries and D65, x and y of each.
  Imf::addChromaticities(header, Imf::Chromaticities({0.64f, 0.33f}, {0.30f, 0.60f}, {0.15f, 0.06f},
                                                     {0.3127f, 0.3290f}));
  const std::string prefix(kPrefix);
  header.insert(prefix + "colorspace", Imf::StringAttribute("linear Rec.709"));
  for (const auto& [name, value] : attributes) {
    header.insert(prefix + name, Imf::StringAttribute(value));
  }
  const auto type = precision == ExrPrecision::kHalf ? Imf::HALF : Imf::FLOAT;
  for (const std::string& name : channels) header.channels().insert(name, Imf::Channel(type));
  try {
    output_->file = std::make_unique<Imf::OutputFile>(output_->stream, header);
  } catch (const std::exception& error) {
    Fail(error.what());
  }
}

ExrWriter::~ExrWriter() = default;
ExrWriter::ExrWriter(ExrWriter&&) noexcept = default;

void ExrWriter::Fail(const std::string& reason) {
  output_.reset();
  std::error_code error;
  std::filesystem::remove(file_, error);
  throw EnvironmentError(file_.string() + ": cannot write the image: " + reason +
                         "; check the folder's permissions and the free space");
}

void ExrWriter::WriteFloats(const Image& rows) {
  Imf::FrameBuffer planes;
  for (size_t c = 0; c < rows.channels.size(); ++c) {
    planes.insert(output_->channels[c],
                  Imf::Slice::Make(Imf::FLOAT, rows.channel(static_cast<int>(c)).data(),
                                   Imath::V2i(0, next_row_), rows.width, rows.height));
  }
  output_->file->setFrameBuffer(planes);
  output_->file->writePixels(rows.height);
}

void ExrWriter::WriteHalves(const Image& rows) {
  const size_t width = static_cast<size_t>(rows.width), channels = rows.channels.size();
  const size_t plane = width * static_cast<size_t>(std::min(rows.height, kConvertedRows));
  std::vector<half> halves(channels * plane);
  for (int begin = 0; begin < rows.height; begin += kConvertedRows) {
    const int count = std::min(kConvertedRows, rows.height - begin);
    Imf::FrameBuffer planes;
    for (size_t c = 0; c < channels; ++c) {
      const auto from =
          rows.channel(static_cast<int>(c))
              .subspan(static_cast<size_t>(begin) * width, static_cast<size_t>(count) * width);
      half* to = halves.data() + c * plane;
      for (size_t i = 0; i < from.size(); ++i) to[i] = half(std::min(from[i], kLargestHalf));
      planes.insert(
          output_->channels[c],
          Imf::Slice::Make(Imf::HALF, to, Imath::V2i(0, next_row_ + begin), rows.width, count));
    }
    output_->file->setFrameBuffer(planes);
    output_->file->writePixels(count);
  }
}

void ExrWriter::Write(const Image& rows) {
  if (rows.width != output_->width || rows.channels.size() != output_->channels.size() ||
      next_row_ + rows.height > output_->height) {
    throw std::invalid_argument("ExrWriter: rows of another image");
  }
  try {
    output_->precision == ExrPrecision::kHalf ? WriteHalves(rows) : WriteFloats(rows);
  } catch (const std::exception& error) {
    Fail(error.what());
  }
  if (!output_->stream.well()) Fail("not all of it could be written");
  next_row_ += rows.height;
}

void ExrWriter::Close() {
  if (next_row_ != output_->height) throw std::logic_error("ExrWriter: rows are missing");
  output_->file.reset();  // writes where its blocks lie
  if (!output_->stream.Close()) Fail("not all of it could be written");
}

}  // namespace glint
