#include "datasets/synth/environment_light.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/errors/errors.h"
#include "base/images/image.h"
#include "base/photos/photo.h"
#include "fitting/render/renderer.h"

namespace glint {
namespace {

// Cells of the upper hemisphere, ring by ring from the zenith.
class Cells {
 public:
  explicit Cells(int rings) : rings_(rings) {
    first_.push_back(0);
    for (int ring = 0; ring < rings; ++ring) {
      const double middle = (ring + 0.5) * 0.5 * std::numbers::pi / rings;
      const int sectors = std::max(4, static_cast<int>(std::lround(4 * rings * std::sin(middle))));
      first_.push_back(first_.back() + static_cast<size_t>(sectors));
    }
  }
  size_t count() const { return first_.back(); }
  // Of the direction with polar angle in [0, π/2) and azimuth in [0, 2π).
  size_t At(double polar, double azimuth) const {
    const auto ring = static_cast<size_t>(
        std::clamp(static_cast<int>(polar / (0.5 * std::numbers::pi) * rings_), 0, rings_ - 1));
    const size_t sectors = first_[ring + 1] - first_[ring];
    const auto sector =
        static_cast<size_t>(azimuth / (2 * std::numbers::pi) * static_cast<double>(sectors));
    return first_[ring] + std::min(sector, sectors - 1);
  }

 private:
  int rings_;
  std::vector<size_t> first_;
};

// ∫ ω dω over a pixel of an equirectangular map, exact.
Vec3d PixelMoment(double polar0, double polar1, double azimuth0, double azimuth1) {
  const double sine_squares =
      0.5 * (polar1 - polar0) - 0.25 * (std::sin(2 * polar1) - std::sin(2 * polar0));
  const double s0 = std::sin(polar0), s1 = std::sin(polar1);
  return {sine_squares * (std::sin(azimuth1) - std::sin(azimuth0)),
          sine_squares * (std::cos(azimuth0) - std::cos(azimuth1)),
          0.5 * (s1 * s1 - s0 * s0) * (azimuth1 - azimuth0)};
}

// Per cell and channel ∫ L ω dω.
using Moments = std::vector<std::array<Vec3d, 3>>;

// The cell's light comes from where its mean over channels does.
DirectionalLight LightOf(const std::array<Vec3d, 3>& moment) {
  DirectionalLight light;
  Vec3d sum{0, 0, 0};
  for (const Vec3d& channel : moment) {
    for (size_t i = 0; i < 3; ++i) sum[i] += channel[i];
  }
  const double length = std::hypot(sum[0], sum[1], sum[2]);
  if (!(length > 0)) return light;
  for (size_t i = 0; i < 3; ++i) light.direction[i] = sum[i] / length;
  for (size_t c = 0; c < 3; ++c) {
    for (size_t i = 0; i < 3; ++i) light.irradiance_rgb[c] += moment[c][i] * light.direction[i];
  }
  return light;
}

EnvironmentLight FromImage(const Image& image, int rings) {
  const Cells cells(rings);
  Moments moments(cells.count(), {Vec3d{0, 0, 0}, Vec3d{0, 0, 0}, Vec3d{0, 0, 0}});
  for (int row = 0; 2 * row < image.height; ++row) {
    const double polar0 = std::numbers::pi * row / image.height;
    const double polar1 =
        std::min(0.5 * std::numbers::pi, std::numbers::pi * (row + 1) / image.height);
    for (int column = 0; column < image.width; ++column) {
      const double azimuth0 = 2 * std::numbers::pi * column / image.width;
      const double azimuth1 = 2 * std::numbers::pi * (column + 1) / image.width;
      const Vec3d moment = PixelMoment(polar0, polar1, azimuth0, azimuth1);
      auto& cell = moments[cells.At(0.5 * (polar0 + polar1), 0.5 * (azimuth0 + azimuth1))];
      const size_t pixel = static_cast<size_t>(row) * image.width + static_cast<size_t>(column);
      for (int c = 0; c < 3; ++c) {
        const double radiance = std::max(0.0f, image.channel(c)[pixel]);
        for (size_t i = 0; i < 3; ++i) cell[static_cast<size_t>(c)][i] += radiance * moment[i];
      }
    }
  }
  EnvironmentLight environment;
  environment.cell_rad = 0.5 * std::numbers::pi / rings;
  for (const auto& moment : moments) {
    const DirectionalLight light = LightOf(moment);
    const auto& e = light.irradiance_rgb;
    if (e[0] + e[1] + e[2] > 0) environment.lights.push_back(light);
  }
  return environment;
}

}  // namespace

Vec3d EnvironmentLight::PlaneIrradiance() const {
  Vec3d sum{0, 0, 0};
  for (const DirectionalLight& light : lights) {
    for (size_t c = 0; c < 3; ++c) sum[c] += light.irradiance_rgb[c] * light.direction[2];
  }
  return sum;
}

void EnvironmentLight::Scale(double factor) {
  for (DirectionalLight& light : lights) {
    for (double& value : light.irradiance_rgb) value *= factor;
  }
}

EnvironmentLight ConstantEnvironment(int rings) {
  Image white(512, 256, {"R", "G", "B"});
  std::fill(white.samples.begin(), white.samples.end(), 1.0f);
  return FromImage(white, rings);
}

EnvironmentLight ReadEnvironment(const std::filesystem::path& file, int rings) {
  const Photo photo = ReadPhoto(file);
  if (!photo.is_float()) {
    throw UserError(file, "environment", "a picture of " + std::to_string(photo.bits) + " bits",
                    "give a linear equirectangular map, .hdr or .exr");
  }
  EnvironmentLight environment = FromImage(photo.image.Planes(), rings);
  if (environment.lights.empty()) {
    throw UserError(file, "environment", "no light above the horizon",
                    "give an equirectangular map whose upper half is not black");
  }
  return environment;
}

SvbrdfMaps WidenRoughness(const SvbrdfMaps& maps, double cell_rad) {
  SvbrdfMaps wide = maps;
  const double width = 0.5 * cell_rad;
  for (float& r : wide.plane(kRoughness)) {
    const double alpha = static_cast<double>(r) * r;
    r = static_cast<float>(std::min(1.0, std::pow(alpha * alpha + width * width, 0.25)));
  }
  return wide;
}

void AddEnvironment(const EnvironmentLight& environment, const SvbrdfMaps& maps,
                    const SamplePlane& plane, const View& view,
                    const ReflectanceConvention& convention, float* rgb_planar, int threads) {
  const SvbrdfMaps wide = WidenRoughness(maps, environment.cell_rad);
  ReflectanceConvention distant = convention;
  distant.falloff = LightFalloff::kNone;
  const double far_mm = 1e4 * std::max(plane.width_mm, plane.height_mm);
  View lit = view;
  lit.ambient_rgb = {0, 0, 0};
  std::vector<float> one(3 * maps.texels());
  for (const DirectionalLight& light : environment.lights) {
    for (size_t i = 0; i < 3; ++i) lit.light_in_sample_mm[i] = far_mm * light.direction[i];
    lit.light_rgb = light.irradiance_rgb;
    RenderView(wide, plane, lit, distant, one.data(), threads);
    for (size_t i = 0; i < one.size(); ++i) rgb_planar[i] += one[i];
  }
}

}  // namespace glint
