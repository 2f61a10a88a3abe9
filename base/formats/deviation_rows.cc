#include "base/formats/deviation_rows.h"

#include <algorithm>
#include <cmath>
#include <span>

#include "base/errors/errors.h"

namespace glint {
namespace {

constexpr int kRowsAtOnce = 256;

}  // namespace

const std::vector<std::string>& DeviationChannels() {
  static const std::vector<std::string> names = {"normal.X",   "normal.Y",   "diffuse.R",
                                                 "diffuse.G",  "diffuse.B",  "specular.R",
                                                 "specular.G", "specular.B", "roughness.Y"};
  return names;
}

void WriteDeviations(const std::filesystem::path& file, const SvbrdfDeviations& deviations,
                     int width, int height, const ReflectanceConvention& convention) {
  const std::vector<Taps> across = TapsBetween(deviations.width, width);
  const std::vector<Taps> down = TapsBetween(deviations.height, height);
  ExrWriter writer(file, width, height, DeviationChannels(), {{"convention", ToString(convention)}},
                   ExrPrecision::kHalf);
  for (int first = 0; first < height; first += kRowsAtOnce) {
    const int rows = std::min(kRowsAtOnce, height - first);
    Image image(width, rows, DeviationChannels());
    image.samples = ResamplePlanes(
        deviations.planes, deviations.width, deviations.height, across,
        std::span(down).subspan(static_cast<size_t>(first), static_cast<size_t>(rows)));
    writer.Write(image);
  }
  writer.Close();
}

ResampledDeviations::ResampledDeviations(const std::filesystem::path& file, int width, int height)
    : file_(file),
      reader_(file),
      across_(TapsBetween(reader_.width(), width)),
      down_(TapsBetween(reader_.height(), height)) {
  const std::vector<std::string>& present = reader_.channels();
  for (const std::string& name : DeviationChannels()) {
    const auto found = std::find(present.begin(), present.end(), name);
    if (found == present.end()) {
      throw UserError(file, name, "no such channel", "run glint-fit again");
    }
    channels_.push_back(static_cast<int>(found - present.begin()));
  }
}

SvbrdfDeviations ResampledDeviations::ReadFile(int first_row, int rows) {
  const Image image = reader_.Read(first_row, rows);
  SvbrdfDeviations deviations(image.width, image.height);
  for (int plane = 0; plane < kDeviationPlanes; ++plane) {
    const auto values = image.channel(channels_[static_cast<size_t>(plane)]);
    for (const float value : values) {
      if (std::isfinite(value) && value > 0) continue;
      throw UserError(file_, DeviationChannels()[static_cast<size_t>(plane)], std::to_string(value),
                      "standard deviations are above 0; run glint-fit again");
    }
    std::copy(values.begin(), values.end(), deviations.plane(plane).begin());
  }
  return deviations;
}

SvbrdfDeviations ResampledDeviations::Read(int first_row, int rows) {
  const int width = static_cast<int>(across_.size());
  if (width == reader_.width() && static_cast<int>(down_.size()) == reader_.height()) {
    return ReadFile(first_row, rows);
  }
  SvbrdfDeviations deviations(width, rows);
  const auto down =
      std::span(down_).subspan(static_cast<size_t>(first_row), static_cast<size_t>(rows));
  for (const TapGroup& group : GroupTaps(down, kRowsAtOnce)) {
    const SvbrdfDeviations from = ReadFile(group.first_input, group.inputs);
    PutRows(ResamplePlanes(from.planes, from.width, from.height, across_, group.taps), width, rows,
            group.first_output, deviations.planes);
  }
  return deviations;
}

}  // namespace glint
