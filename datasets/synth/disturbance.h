// What goes wrong in real captures, done to synthetic views on purpose: the photographs are made
// with it, the manifest does not know of it. Table 2 and Figs. 13, 14 and 17 of Gao et al. 2019.
#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include "base/formats/rectified_set.h"
#include "base/reflectance/view.h"
#include "datasets/synth/environment_light.h"
#include "fitting/photographs/picture_shift.h"

namespace glint {

struct Disturbance {
  // Every light is turned about the sample's centre by this angle, in a direction of its own …
  double light_off_deg = 0;
  // Root mean square of the distances by which each view's four corners are moved, independently;
  // between them the picture moves bilinearly.
  double registration_texel = 0;
  // Light of the surroundings, in percent of the flash: the mean radiance that a white Lambertian
  // plane reflects of the environment, seen from the top, over that which it reflects of the flash
  // in the first view (mean over the plane and the channels).
  double environment_percent = 0;
  // Equirectangular radiance map (environment_light.h); empty: a white surround.
  std::filesystem::path environment;
  // … or all in one direction: the flash is elsewhere beside the lens of an upright camera.
  bool light_together = false;

  bool any() const {
    return light_off_deg > 0 || registration_texel > 0 || environment_percent > 0;
  }
};

// A light at `light_mm` turned by `angle_deg` about the origin, toward `azimuth_rad` round its own
// direction; its distance stays.
Vec3d TurnLight(const Vec3d& light_mm, double angle_deg, double azimuth_rad);

// The disturbance of view `index` of the set with `seed`; views of longer sets are the same.
struct ViewDisturbance {
  double light_azimuth_rad = 0;
  CornerShifts shifts;
};
ViewDisturbance DrawDisturbance(const Disturbance& disturbance, std::uint64_t seed, int index);

// The environment that shines `percent` of what the flash in `first` does; see Disturbance.
EnvironmentLight ScaledEnvironment(const Disturbance& disturbance, const View& first,
                                   const SamplePlane& plane,
                                   const ReflectanceConvention& convention);

}  // namespace glint
