#include "base/formats/svbrdf_rows.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "base/errors/errors.h"

namespace glint {
namespace {

const std::vector<std::string>& SvbrdfChannels() {
  static const std::vector<std::string> names = {
      "normal.X",  "normal.Y",   "normal.Z",   "diffuse.R",  "diffuse.G",
      "diffuse.B", "specular.R", "specular.G", "specular.B", "roughness.Y"};
  return names;
}

constexpr char kConventionAttribute[] = "reflectance_convention";
constexpr int kSvbrdfRowsAtOnce = 256;  // of the file, where its maps are made smaller

void CheckPlane(const std::filesystem::path& file, int plane, std::span<const float> values) {
  const bool normal = plane <= kNormalZ;
  const float low = normal ? -1.001f : -1e-6f;
  const float high = 1.001f;
  for (const float value : values) {
    if (std::isfinite(value) && value >= low && value <= high) continue;
    throw UserError(
        file, SvbrdfChannels()[static_cast<size_t>(plane)], std::to_string(value),
        normal ? "components of a unit normal lie in [-1, 1]" : "values of this map lie in [0, 1]");
  }
}

ReflectanceConvention ConventionOf(const std::filesystem::path& file, const ExrReader& reader) {
  const auto found = reader.attributes().find(kConventionAttribute);
  const std::string text = found == reader.attributes().end() ? "" : found->second;
  try {
    return ParseReflectanceConvention(text);
  } catch (const std::invalid_argument&) {
    throw UserError(file, "glint:" + std::string(kConventionAttribute), "'" + text + "'",
                    "write the reflectance convention into the header (docs/conventions.md)");
  }
}

void Normalise(SvbrdfMaps* maps) {
  auto x = maps->plane(kNormalX), y = maps->plane(kNormalY), z = maps->plane(kNormalZ);
  for (size_t i = 0; i < maps->texels(); ++i) {
    const float length = std::sqrt(x[i] * x[i] + y[i] * y[i] + z[i] * z[i]);
    if (length < 1e-6f) {
      x[i] = y[i] = 0;
      z[i] = 1;
      continue;
    }
    x[i] /= length;
    y[i] /= length;
    z[i] /= length;
  }
}

}  // namespace

SvbrdfReader::SvbrdfReader(const std::filesystem::path& file, ReflectanceConvention* convention)
    : file_(file), reader_(file) {
  const std::vector<std::string>& present = reader_.channels();
  for (size_t plane = 0; plane < channels_.size(); ++plane) {
    const auto found = std::find(present.begin(), present.end(), SvbrdfChannels()[plane]);
    if (found == present.end()) {
      throw UserError(file, SvbrdfChannels()[plane], "no such channel",
                      "an svbrdf.exr has normal.X/Y/Z, diffuse.R/G/B, specular.R/G/B, roughness.Y");
    }
    channels_[plane] = static_cast<int>(found - present.begin());
  }
  if (convention != nullptr) *convention = ConventionOf(file, reader_);
}

SvbrdfMaps SvbrdfReader::Read(int first_row, int rows) {
  const Image image = reader_.Read(first_row, rows);
  SvbrdfMaps maps(image.width, image.height);
  for (int plane = 0; plane < kSvbrdfPlanes; ++plane) {
    const auto values = image.channel(channels_[static_cast<size_t>(plane)]);
    CheckPlane(file_, plane, values);
    std::copy(values.begin(), values.end(), maps.plane(plane).begin());
  }
  return maps;
}

SvbrdfWriter::SvbrdfWriter(const std::filesystem::path& file, int width, int height,
                           const ReflectanceConvention& convention)
    : writer_(file, width, height, SvbrdfChannels(),
              {{kConventionAttribute, ToString(convention)}}) {}

void SvbrdfWriter::Write(const SvbrdfMaps& rows) {
  Image image(rows.width, rows.height, SvbrdfChannels());
  image.samples = rows.planes;
  writer_.Write(image);
}

SvbrdfMaps ResampleSvbrdf(const SvbrdfMaps& maps, int width, int height) {
  if (width == maps.width && height == maps.height) return maps;
  SvbrdfMaps result(width, height);
  result.planes = ResamplePlanes(maps.planes, maps.width, maps.height,
                                 TapsBetween(maps.width, width), TapsBetween(maps.height, height));
  Normalise(&result);
  return result;
}

ResampledSvbrdf::ResampledSvbrdf(const std::filesystem::path& file, int width, int height,
                                 ReflectanceConvention* convention)
    : reader_(file, convention),
      across_(TapsBetween(reader_.width(), width)),
      down_(TapsBetween(reader_.height(), height)) {}

SvbrdfMaps ResampledSvbrdf::Read(int first_row, int rows) {
  if (width() == reader_.width() && height() == reader_.height()) {
    return reader_.Read(first_row, rows);
  }
  SvbrdfMaps maps(width(), rows);
  const auto down =
      std::span(down_).subspan(static_cast<size_t>(first_row), static_cast<size_t>(rows));
  for (const TapGroup& group : GroupTaps(down, kSvbrdfRowsAtOnce)) {
    const SvbrdfMaps from = reader_.Read(group.first_input, group.inputs);
    SvbrdfMaps part(width(), static_cast<int>(group.taps.size()));
    part.planes = ResamplePlanes(from.planes, from.width, from.height, across_, group.taps);
    Normalise(&part);
    PutRows(part.planes, width(), rows, group.first_output, maps.planes);
  }
  return maps;
}

}  // namespace glint
