#include "base/images/image.h"

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <memory>

#include "base/errors/errors.h"
#include "base/images/exr_rows.h"
#include "base/images/oiio.h"
#include "base/images/png_rows.h"
#include "base/images/png_samples.h"

namespace glint {

int Image::ChannelIndex(const std::string& name) const {
  const auto found = std::find(channels.begin(), channels.end(), name);
  return found == channels.end() ? -1 : static_cast<int>(found - channels.begin());
}

void WriteExr(const std::filesystem::path& file, const Image& image,
              const std::map<std::string, std::string>& attributes) {
  ExrWriter writer(file, image.width, image.height, image.channels, attributes);
  writer.Write(image);
  writer.Close();
}

void WritePng(const std::filesystem::path& file, const Image& image, int bits,
              const PngTags& tags) {
  PngWriter writer(file, image.width, image.height, static_cast<int>(image.channels.size()), bits,
                   tags);
  writer.Write(image);
  writer.Close();
}

std::string EncodePng(const Image& image, int bits, const PngTags& tags) {
  SetUpOiio();
  OIIO::Filesystem::IOVecOutput encoded;
  const std::string name = "memory.png";
  const std::unique_ptr<OIIO::ImageOutput> output = OIIO::ImageOutput::create(name, &encoded);
  const auto fail = [&](const std::string& reason) {
    throw EnvironmentError("a PNG cannot be encoded: " + reason);
  };
  if (!output) fail(OIIO::geterror());
  const OIIO::ImageSpec spec =
      PngSpec(image.width, image.height, static_cast<int>(image.channels.size()), bits, tags);
  if (!output->open(name, spec)) fail(output->geterror());
  const PngSamples samples(image, bits);
  if (!output->write_image(samples.type(), samples.data())) fail(output->geterror());
  if (!output->close()) fail(output->geterror());
  const auto& bytes = encoded.buffer();
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

ImageHeader ReadImageHeader(const std::filesystem::path& file) {
  const auto input = OpenImage(file);
  const OIIO::ImageSpec& spec = input->spec();
  return {spec.width, spec.height, spec.channelnames};
}

Image ReadExr(const std::filesystem::path& file, std::map<std::string, std::string>* attributes) {
  ExrReader reader(file);
  if (attributes != nullptr) *attributes = reader.attributes();
  return reader.Read(0, reader.height());
}

}  // namespace glint
