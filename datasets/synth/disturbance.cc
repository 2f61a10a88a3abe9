#include "datasets/synth/disturbance.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "datasets/procedural/random.h"
#include "fitting/render/renderer.h"

namespace glint {
namespace {

Vec3d Cross(const Vec3d& a, const Vec3d& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

double Length(const Vec3d& v) { return std::hypot(v[0], v[1], v[2]); }

// Box and Muller's.
double MeanOf(const Vec3d& rgb) { return (rgb[0] + rgb[1] + rgb[2]) / 3; }

// Mean radiance of a white Lambertian plane under the flash.
double WhitePlaneRadiance(const View& view, const SamplePlane& plane,
                          const ReflectanceConvention& convention) {
  SvbrdfMaps white(plane.width, plane.height);
  for (const int p : {kNormalZ, kDiffuseR, kDiffuseG, kDiffuseB, kRoughness}) {
    std::fill(white.plane(p).begin(), white.plane(p).end(), 1.0f);
  }
  // A specular albedo of 0 still reflects at grazing angles (Fresnel): negligible from the top.
  std::vector<float> rgb(3 * white.texels());
  RenderView(white, plane, view, convention, rgb.data());
  double sum = 0;
  for (const float value : rgb) sum += value;
  return sum / static_cast<double>(rgb.size());
}

}  // namespace

Vec3d TurnLight(const Vec3d& light_mm, double angle_deg, double azimuth_rad) {
  const double distance = Length(light_mm);
  if (angle_deg == 0 || !(distance > 0)) return light_mm;
  const Vec3d axis{light_mm[0] / distance, light_mm[1] / distance, light_mm[2] / distance};
  const Vec3d helper = std::abs(axis[0]) < 0.9 ? Vec3d{1, 0, 0} : Vec3d{0, 1, 0};
  Vec3d u = Cross(axis, helper);
  const double length = Length(u);
  for (double& value : u) value /= length;
  const Vec3d v = Cross(axis, u);
  const double angle = angle_deg * std::numbers::pi / 180;
  Vec3d turned;
  for (size_t i = 0; i < 3; ++i) {
    const double aside = std::cos(azimuth_rad) * u[i] + std::sin(azimuth_rad) * v[i];
    turned[i] = distance * (std::cos(angle) * axis[i] + std::sin(angle) * aside);
  }
  return turned;
}

ViewDisturbance DrawDisturbance(const Disturbance& disturbance, std::uint64_t seed, int index) {
  procedural::Rng rng(procedural::Mix64(seed) ^
                      procedural::Mix64(0xd157u + static_cast<std::uint64_t>(index)));
  ViewDisturbance drawn;
  drawn.light_azimuth_rad = 2 * std::numbers::pi * rng.Unit();
  if (disturbance.light_together && index > 0) {
    drawn.light_azimuth_rad = DrawDisturbance(disturbance, seed, 0).light_azimuth_rad;
  }
  const double deviation = disturbance.registration_texel / std::numbers::sqrt2;
  for (int corner = 0; corner < 4; ++corner) {
    drawn.shifts.column[corner] = deviation * rng.Normal();
    drawn.shifts.row[corner] = deviation * rng.Normal();
  }
  return drawn;
}

EnvironmentLight ScaledEnvironment(const Disturbance& disturbance, const View& first,
                                   const SamplePlane& plane,
                                   const ReflectanceConvention& convention) {
  EnvironmentLight environment = disturbance.environment.empty()
                                     ? ConstantEnvironment()
                                     : ReadEnvironment(disturbance.environment);
  const double reflected = MeanOf(environment.PlaneIrradiance()) / std::numbers::pi;
  View unexposed = first;
  unexposed.exposure = 1;
  environment.Scale(disturbance.environment_percent / 100 *
                    WhitePlaneRadiance(unexposed, plane, convention) / reflected);
  return environment;
}

}  // namespace glint
