#include "pipeline/contract/svbrdf_file.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "base/resampling/resampling.h"
#include "pipeline/contract/errors.h"
#include "pipeline/contract/image.h"

namespace glint {
namespace {

const std::vector<std::string>& ChannelNames() {
  static const std::vector<std::string> names = {
      "normal.X",  "normal.Y",   "normal.Z",   "diffuse.R",  "diffuse.G",
      "diffuse.B", "specular.R", "specular.G", "specular.B", "roughness.Y"};
  return names;
}

constexpr char kConventionAttribute[] = "reflectance_convention";

void CheckPlane(const std::filesystem::path& file, int plane, std::span<const float> values) {
  const bool normal = plane <= kNormalZ;
  const float low = normal ? -1.001f : -1e-6f;
  const float high = 1.001f;
  for (const float value : values) {
    if (std::isfinite(value) && value >= low && value <= high) continue;
    throw UserError(
        file, ChannelNames()[static_cast<size_t>(plane)], std::to_string(value),
        normal ? "components of a unit normal lie in [-1, 1]" : "values of this map lie in [0, 1]");
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

std::vector<Taps> TapsBetween(int from, int to) {
  return from > to ? AreaTaps(from, to) : TentTaps(from, to);
}

}  // namespace

void WriteSvbrdf(const std::filesystem::path& file, const SvbrdfMaps& maps,
                 const ReflectanceConvention& convention) {
  Image image(maps.width, maps.height, ChannelNames());
  image.samples = maps.planes;
  WriteExr(file, image, {{kConventionAttribute, ToString(convention)}});
}

SvbrdfMaps ReadSvbrdf(const std::filesystem::path& file, ReflectanceConvention* convention) {
  std::map<std::string, std::string> attributes;
  const Image image = ReadExr(file, &attributes);
  SvbrdfMaps maps(image.width, image.height);
  for (int plane = 0; plane < kSvbrdfPlanes; ++plane) {
    const std::string& name = ChannelNames()[static_cast<size_t>(plane)];
    const int channel = image.ChannelIndex(name);
    if (channel < 0) {
      throw UserError(file, name, "no such channel",
                      "an svbrdf.exr has normal.X/Y/Z, diffuse.R/G/B, specular.R/G/B, roughness.Y");
    }
    CheckPlane(file, plane, image.channel(channel));
    std::copy(image.channel(channel).begin(), image.channel(channel).end(),
              maps.plane(plane).begin());
  }
  if (convention != nullptr) {
    const std::string text = attributes[kConventionAttribute];
    try {
      *convention = ParseReflectanceConvention(text);
    } catch (const std::invalid_argument&) {
      throw UserError(file, "glint:" + std::string(kConventionAttribute), "'" + text + "'",
                      "write the reflectance convention into the header (docs/conventions.md)");
    }
  }
  return maps;
}

SvbrdfMaps ResampleSvbrdf(const SvbrdfMaps& maps, int width, int height) {
  if (width == maps.width && height == maps.height) return maps;
  SvbrdfMaps result(width, height);
  result.planes = ResamplePlanes(maps.planes, maps.width, maps.height,
                                 TapsBetween(maps.width, width), TapsBetween(maps.height, height));
  Normalise(&result);
  return result;
}

}  // namespace glint
