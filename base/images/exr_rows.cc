#include "base/images/exr_rows.h"

#include <algorithm>
#include <cerrno>
#include <stdexcept>

#include "base/errors/errors.h"
#include "base/images/oiio.h"
#include "base/resampling/resampling.h"

namespace glint {
namespace {

constexpr int kMaxChannels = 64;
constexpr char kPrefix[] = "glint:";
// As many rows are converted between planes and pixels at a time: a multiple of the 32 that are
// compressed together.
constexpr int kConvertedRows = 64;
constexpr float kLargestHalf = 65504;

}  // namespace

struct ExrReader::Input {
  std::unique_ptr<OIIO::ImageInput> file;
};

ExrReader::ExrReader(const std::filesystem::path& file)
    : file_(file), input_(new Input{OpenExr(file, HowRead::kByRows)}) {
  const OIIO::ImageSpec& spec = input_->file->spec();
  if (spec.nchannels > kMaxChannels) {
    throw UserError(file, "channels", std::to_string(spec.nchannels),
                    "at most " + std::to_string(kMaxChannels) + " are read");
  }
  channels_ = spec.channelnames;
  for (const OIIO::ParamValue& value : spec.extra_attribs) {
    const std::string name = value.name().string();
    if (name.rfind(kPrefix, 0) != 0) continue;
    attributes_[name.substr(sizeof kPrefix - 1)] = value.get_string();
  }
}

ExrReader::~ExrReader() = default;
ExrReader::ExrReader(ExrReader&&) noexcept = default;

int ExrReader::width() const { return input_->file->spec().width; }
int ExrReader::height() const { return input_->file->spec().height; }
ExrPrecision ExrReader::precision() const {
  return input_->file->spec().format == OIIO::TypeHalf ? ExrPrecision::kHalf : ExrPrecision::kFloat;
}

Image ExrReader::Read(int first_row, int rows) {
  const OIIO::ImageSpec& spec = input_->file->spec();
  if (first_row < 0 || rows < 1 || first_row + rows > spec.height) {
    throw std::invalid_argument("ExrReader: rows outside of the image");
  }
  RequireMemoryForRows(file_, spec, rows);
  Image image(spec.width, rows, channels_);
  const size_t channels = channels_.size();
  std::vector<float> interleaved(channels * static_cast<size_t>(spec.width) *
                                 static_cast<size_t>(std::min(rows, kConvertedRows)));
  for (int begin = 0; begin < rows; begin += kConvertedRows) {
    const int end = std::min(begin + kConvertedRows, rows), top = spec.y + first_row;
    if (!input_->file->read_scanlines(0, 0, top + begin, top + end, 0, 0, spec.nchannels,
                                      OIIO::TypeFloat, interleaved.data())) {
      RejectTruncated(file_, input_->file.get());
    }
    const size_t offset = static_cast<size_t>(begin) * static_cast<size_t>(spec.width);
    const size_t count = static_cast<size_t>(end - begin) * static_cast<size_t>(spec.width);
    for (size_t c = 0; c < channels; ++c) {
      float* plane = image.channel(static_cast<int>(c)).data() + offset;
      for (size_t i = 0; i < count; ++i) plane[i] = interleaved[i * channels + c];
    }
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
  std::unique_ptr<OIIO::ImageOutput> file;
  OIIO::ImageSpec spec;
};

ExrWriter::ExrWriter(const std::filesystem::path& file, int width, int height,
                     const std::vector<std::string>& channels,
                     const std::map<std::string, std::string>& attributes, ExrPrecision precision)
    : file_(file), output_(new Output) {
  SetUpOiio();
  OIIO::ImageSpec& spec = output_->spec;
  spec = OIIO::ImageSpec(width, height, static_cast<int>(channels.size()),
                         precision == ExrPrecision::kHalf ? OIIO::TypeHalf : OIIO::TypeFloat);
  spec.channelnames = channels;
  // Wavelets: beside "zip" a fifth smaller and written in half the time where maps are floats, as
  // small and written six times as fast where views are half floats (docs/experiments/run-time.md).
  spec.attribute("compression", "piz");
  spec.attribute("DateTime", kNoDate);
  // Rec.709 primaries and D65, as x, y of red, green, blue, white.
  const float chromaticities[8] = {0.64f, 0.33f, 0.30f, 0.60f, 0.15f, 0.06f, 0.3127f, 0.3290f};
  spec.attribute("chromaticities", OIIO::TypeDesc(OIIO::TypeDesc::FLOAT, 8), chromaticities);
  spec.attribute("glint:colorspace", "linear Rec.709");
  for (const auto& [name, value] : attributes) spec.attribute(kPrefix + name, value);
  errno = 0;
  output_->file = OIIO::ImageOutput::create(file.string());
  if (!output_->file) Fail(OIIO::geterror());
  if (!output_->file->open(file.string(), spec)) Fail(output_->file->geterror());
}

ExrWriter::~ExrWriter() = default;
ExrWriter::ExrWriter(ExrWriter&&) noexcept = default;

void ExrWriter::Fail(const std::string& reason) {
  output_->file.reset();
  std::error_code error;
  std::filesystem::remove(file_, error);
  throw EnvironmentError(file_.string() + ": cannot write the image: " + reason +
                         "; check the folder's permissions and the free space");
}

void ExrWriter::Write(const Image& rows) {
  const OIIO::ImageSpec& spec = output_->spec;
  if (rows.width != spec.width || rows.channels.size() != spec.channelnames.size() ||
      next_row_ + rows.height > spec.height) {
    throw std::invalid_argument("ExrWriter: rows of another image");
  }
  const size_t channels = rows.channels.size(), width = static_cast<size_t>(rows.width);
  std::vector<float> interleaved(channels * width *
                                 static_cast<size_t>(std::min(rows.height, kConvertedRows)));
  for (int begin = 0; begin < rows.height; begin += kConvertedRows) {
    const int end = std::min(begin + kConvertedRows, rows.height);
    const size_t offset = static_cast<size_t>(begin) * width;
    const size_t count = static_cast<size_t>(end - begin) * width;
    for (size_t c = 0; c < channels; ++c) {
      const float* plane = rows.channel(static_cast<int>(c)).data() + offset;
      for (size_t i = 0; i < count; ++i) interleaved[i * channels + c] = plane[i];
    }
    if (spec.format == OIIO::TypeHalf) {
      for (float& sample : interleaved) sample = std::min(sample, kLargestHalf);
    }
    if (!output_->file->write_scanlines(next_row_ + begin, next_row_ + end, 0, OIIO::TypeFloat,
                                        interleaved.data())) {
      Fail(output_->file->geterror());
    }
  }
  next_row_ += rows.height;
}

void ExrWriter::Close() {
  if (next_row_ != output_->spec.height) throw std::logic_error("ExrWriter: rows are missing");
  if (!output_->file->close()) Fail(output_->file->geterror());
}

}  // namespace glint
