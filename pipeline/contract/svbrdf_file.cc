#include "pipeline/contract/svbrdf_file.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

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

// Weights with which source samples make target sample i, in one dimension: area average when
// shrinking, linear interpolation when growing.
struct Taps {
  int first = 0;
  std::vector<float> weights;
};

std::vector<Taps> MakeTaps(int from, int to) {
  std::vector<Taps> taps(static_cast<size_t>(to));
  const double scale = static_cast<double>(from) / to;
  for (int i = 0; i < to; ++i) {
    Taps& tap = taps[static_cast<size_t>(i)];
    if (scale > 1) {
      const double low = i * scale, high = (i + 1) * scale;
      tap.first = static_cast<int>(low);
      for (int s = tap.first; s < std::min(from, static_cast<int>(std::ceil(high - 1e-9))); ++s) {
        const double overlap = std::min(high, s + 1.0) - std::max<double>(low, s);
        tap.weights.push_back(static_cast<float>(overlap / scale));
      }
    } else {
      const double centre = std::clamp((i + 0.5) * scale - 0.5, 0.0, from - 1.0);
      tap.first = std::min(static_cast<int>(centre), std::max(0, from - 2));
      const float second = static_cast<float>(centre - tap.first);
      tap.weights = from > 1 ? std::vector<float>{1 - second, second} : std::vector<float>{1.0f};
    }
  }
  return taps;
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
  const std::vector<Taps> columns = MakeTaps(maps.width, width);
  const std::vector<Taps> rows = MakeTaps(maps.height, height);
  SvbrdfMaps result(width, height);
  std::vector<float> narrow(static_cast<size_t>(width) * maps.height);
  for (int p = 0; p < kSvbrdfPlanes; ++p) {
    const float* source = maps.plane(p).data();
    for (int y = 0; y < maps.height; ++y) {
      for (int x = 0; x < width; ++x) {
        const Taps& tap = columns[static_cast<size_t>(x)];
        float sum = 0;
        for (size_t k = 0; k < tap.weights.size(); ++k) {
          sum += tap.weights[k] * source[static_cast<size_t>(y) * maps.width + tap.first + k];
        }
        narrow[static_cast<size_t>(y) * width + x] = sum;
      }
    }
    auto target = result.plane(p);
    for (int y = 0; y < height; ++y) {
      const Taps& tap = rows[static_cast<size_t>(y)];
      for (int x = 0; x < width; ++x) {
        float sum = 0;
        for (size_t k = 0; k < tap.weights.size(); ++k) {
          sum += tap.weights[k] * narrow[(tap.first + k) * width + x];
        }
        target[static_cast<size_t>(y) * width + x] = sum;
      }
    }
  }
  Normalise(&result);
  return result;
}

}  // namespace glint
