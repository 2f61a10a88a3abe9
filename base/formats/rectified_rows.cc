#include "base/formats/rectified_rows.h"

#include <algorithm>
#include <cmath>

#include "base/errors/errors.h"

namespace glint {
namespace {

const std::vector<std::string>& RectifiedChannels() {
  static const std::vector<std::string> names = {"R", "G", "B", "mask.Y"};
  return names;
}

}  // namespace

RectifiedReader::RectifiedReader(const RectifiedSet& set, const RectifiedView& view)
    : file_(set.manifest_file.parent_path() / view.file), reader_(file_) {
  if (reader_.width() != set.plane.width || reader_.height() != set.plane.height) {
    throw UserError(file_, "size",
                    std::to_string(reader_.width()) + "x" + std::to_string(reader_.height()),
                    "the manifest says " + std::to_string(set.plane.width) + "x" +
                        std::to_string(set.plane.height) + "; run rectify again");
  }
  const std::vector<std::string>& present = reader_.channels();
  for (size_t i = 0; i < channels_.size(); ++i) {
    const auto found = std::find(present.begin(), present.end(), RectifiedChannels()[i]);
    if (found == present.end()) {
      throw UserError(file_, RectifiedChannels()[i], "no such channel", "run rectify again");
    }
    channels_[i] = static_cast<int>(found - present.begin());
  }
}

RectifiedImage RectifiedReader::Read(int first_row, int rows) {
  const Image image = reader_.Read(first_row, rows);
  RectifiedImage result{image.width, image.height, {}, {}};
  result.rgb.reserve(3 * image.pixels());
  for (size_t i = 0; i < channels_.size(); ++i) {
    const auto plane = image.channel(channels_[i]);
    if (!std::all_of(plane.begin(), plane.end(), [](float v) { return std::isfinite(v); })) {
      throw UserError(file_, RectifiedChannels()[i], "a value that is not a number",
                      "run rectify again");
    }
    std::vector<float>& values = i < 3 ? result.rgb : result.mask;
    values.insert(values.end(), plane.begin(), plane.end());
    // Colours beyond Rec.709, which photographs with a wider profile have and albedos have not.
    for (float& value : values) value = std::max(value, 0.0f);
  }
  return result;
}

RectifiedWriter::RectifiedWriter(const std::filesystem::path& file, const RectifiedSet& set,
                                 const RectifiedView& view)
    : writer_(file, set.plane.width, set.plane.height, RectifiedChannels(),
              {{"reflectance_convention", ToString(set.convention)}},
              view.ldr ? ExrPrecision::kHalf : ExrPrecision::kFloat) {}

void RectifiedWriter::Write(const RectifiedImage& rows) {
  Image image(rows.width, rows.height, RectifiedChannels());
  std::copy(rows.rgb.begin(), rows.rgb.end(), image.samples.begin());
  std::copy(rows.mask.begin(), rows.mask.end(), image.channel(3).begin());
  writer_.Write(image);
}

}  // namespace glint
