#include "pipeline/contract/image.h"

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <memory>

#include "pipeline/contract/errors.h"
#include "pipeline/contract/files.h"
#include "pipeline/contract/oiio.h"

namespace glint {
namespace {

constexpr int kMaxChannels = 64;
// A fixed date keeps the library from writing the present one.
constexpr char kNoDate[] = "1970:01:01 00:00:00";

void Write(const std::filesystem::path& file, const OIIO::ImageSpec& spec, OIIO::TypeDesc type,
           const void* interleaved) {
  SetUpOiio();
  const std::unique_ptr<OIIO::ImageOutput> output = OIIO::ImageOutput::create(file.string());
  errno = 0;
  const auto fail = [&](const std::string& reason) {
    std::error_code error;
    std::filesystem::remove(file, error);
    throw EnvironmentError(file.string() + ": cannot write the image: " + reason +
                           "; check the folder's permissions and the free space");
  };
  if (!output) fail(OIIO::geterror());
  if (!output->open(file.string(), spec)) fail(output->geterror());
  if (!output->write_image(type, interleaved)) fail(output->geterror());
  if (!output->close()) fail(output->geterror());
}

std::string EncodedPng(const OIIO::ImageSpec& spec, OIIO::TypeDesc type, const void* interleaved) {
  SetUpOiio();
  OIIO::Filesystem::IOVecOutput encoded;
  const std::string name = "memory.png";
  const std::unique_ptr<OIIO::ImageOutput> output = OIIO::ImageOutput::create(name, &encoded);
  const auto fail = [&](const std::string& reason) {
    throw EnvironmentError("a PNG cannot be encoded: " + reason);
  };
  if (!output) fail(OIIO::geterror());
  if (!output->open(name, spec)) fail(output->geterror());
  if (!output->write_image(type, interleaved)) fail(output->geterror());
  if (!output->close()) fail(output->geterror());
  const auto& bytes = encoded.buffer();
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

// Planar to interleaved in the order `order` (channel index for each written channel).
std::vector<float> Interleave(const Image& image, const std::vector<int>& order) {
  std::vector<float> interleaved(image.pixels() * order.size());
  for (size_t c = 0; c < order.size(); ++c) {
    const auto plane = image.channel(order[c]);
    for (size_t i = 0; i < plane.size(); ++i) interleaved[i * order.size() + c] = plane[i];
  }
  return interleaved;
}

}  // namespace

int Image::ChannelIndex(const std::string& name) const {
  const auto found = std::find(channels.begin(), channels.end(), name);
  return found == channels.end() ? -1 : static_cast<int>(found - channels.begin());
}

void WriteExr(const std::filesystem::path& file, const Image& image,
              const std::map<std::string, std::string>& attributes) {
  OIIO::ImageSpec spec(image.width, image.height, static_cast<int>(image.channels.size()),
                       OIIO::TypeFloat);
  spec.channelnames = image.channels;
  spec.attribute("compression", "zip");
  spec.attribute("DateTime", kNoDate);
  // Rec.709 primaries and D65, as x, y of red, green, blue, white.
  const float chromaticities[8] = {0.64f, 0.33f, 0.30f, 0.60f, 0.15f, 0.06f, 0.3127f, 0.3290f};
  spec.attribute("chromaticities", OIIO::TypeDesc(OIIO::TypeDesc::FLOAT, 8), chromaticities);
  spec.attribute("glint:colorspace", "linear Rec.709");
  for (const auto& [name, value] : attributes) spec.attribute("glint:" + name, value);
  std::vector<int> order(image.channels.size());
  for (size_t c = 0; c < order.size(); ++c) order[c] = static_cast<int>(c);
  const std::vector<float> interleaved = Interleave(image, order);
  Write(file, spec, OIIO::TypeFloat, interleaved.data());
}

// By way of memory: libpng's writer does not say when the disk is full.
void WritePng(const std::filesystem::path& file, const Image& image, int bits,
              const PngTags& tags) {
  WriteFileAtomically(file, EncodePng(image, bits, tags));
}

std::string EncodePng(const Image& image, int bits, const PngTags& tags) {
  const int channels = static_cast<int>(image.channels.size());
  OIIO::ImageSpec spec(image.width, image.height, channels,
                       bits == 16 ? OIIO::TypeUInt16 : OIIO::TypeUInt8);
  spec.attribute("DateTime", kNoDate);
  if (tags.transfer == PngTransfer::kSrgb) spec.attribute("oiio:ColorSpace", "sRGB");
  if (tags.pixels_per_m > 0) {
    spec.attribute("XResolution", static_cast<float>(tags.pixels_per_m / 100));
    spec.attribute("YResolution", static_cast<float>(tags.pixels_per_m / 100));
    spec.attribute("ResolutionUnit", "cm");
  }
  std::vector<int> order(static_cast<size_t>(channels));
  for (int c = 0; c < channels; ++c) order[static_cast<size_t>(c)] = c;
  const std::vector<float> interleaved = Interleave(image, order);
  const float scale = bits == 16 ? 65535.0f : 255.0f;
  std::vector<std::uint16_t> rounded(interleaved.size());
  std::vector<std::uint8_t> bytes(bits == 16 ? 0 : interleaved.size());
  for (size_t i = 0; i < interleaved.size(); ++i) {
    const float value =
        std::isfinite(interleaved[i]) ? std::clamp(interleaved[i], 0.0f, 1.0f) : 0.0f;
    rounded[i] = static_cast<std::uint16_t>(std::lround(value * scale));
    if (bits != 16) bytes[i] = static_cast<std::uint8_t>(rounded[i]);
  }
  return bits == 16 ? EncodedPng(spec, OIIO::TypeUInt16, rounded.data())
                    : EncodedPng(spec, OIIO::TypeUInt8, bytes.data());
}

ImageHeader ReadImageHeader(const std::filesystem::path& file) {
  const auto input = OpenImage(file);
  const OIIO::ImageSpec& spec = input->spec();
  return {spec.width, spec.height, spec.channelnames};
}

Image ReadExr(const std::filesystem::path& file, std::map<std::string, std::string>* attributes) {
  const auto input = OpenExr(file);
  const OIIO::ImageSpec& spec = input->spec();
  if (spec.nchannels > kMaxChannels) {
    throw UserError(file, "channels", std::to_string(spec.nchannels),
                    "at most " + std::to_string(kMaxChannels) + " are read");
  }
  Image image(spec.width, spec.height, spec.channelnames);
  const std::vector<float> interleaved = ReadSamples<float>(file, input.get(), OIIO::TypeFloat);
  const size_t channels = image.channels.size();
  for (size_t c = 0; c < channels; ++c) {
    auto plane = image.channel(static_cast<int>(c));
    for (size_t i = 0; i < plane.size(); ++i) plane[i] = interleaved[i * channels + c];
  }
  if (attributes != nullptr) {
    for (const OIIO::ParamValue& value : spec.extra_attribs) {
      const std::string name = value.name().string();
      if (name.rfind("glint:", 0) == 0) (*attributes)[name.substr(6)] = value.get_string();
    }
  }
  return image;
}

}  // namespace glint
