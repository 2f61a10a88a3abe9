#include "base/images/image.h"

#include <algorithm>

#include "base/images/exr_rows.h"
#include "base/images/png_rows.h"

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

Image ReadExr(const std::filesystem::path& file, std::map<std::string, std::string>* attributes) {
  ExrReader reader(file);
  if (attributes != nullptr) *attributes = reader.attributes();
  return reader.Read(0, reader.height());
}

ImageHeader ReadExrHeader(const std::filesystem::path& file) {
  const ExrReader reader(file);
  return {reader.width(), reader.height(), reader.channels()};
}

}  // namespace glint
