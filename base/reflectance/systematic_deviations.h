// Standard deviations of errors that all texels of a sample have in common.
#pragma once

namespace glint {

struct SystematicDeviations {
  double diffuse = 0, specular = 0;  // of albedos, relative to them
  double roughness = 0;
  double slope = 0;  // of each slope of the normal ∝ (slope_x, slope_y, 1)

  bool operator==(const SystematicDeviations&) const = default;
};

}  // namespace glint
