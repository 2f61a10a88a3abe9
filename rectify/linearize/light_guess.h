// A first guess of the flash's power where nobody measured it.
#pragma once

#include <vector>

#include "pipeline/contract/rectified_set.h"

namespace glint {

// Watches rectified views go by and ends with the power that makes the sample's diffuse albedo
// plausible: with q = π·L / (irradiance of a light of power 1), the albedo of a Lambertian texel is
// q / power. Per texel of a coarse grid the smallest q over the views counts, which leaves the
// highlights out; the power then puts the median albedo at 0.3, or higher if bright texels would pass 0.95.
class LightGuess {
 public:
  LightGuess(const SamplePlane& plane, LightFalloff falloff);

  void Add(const View& view, const RectifiedImage& image);

  // 0 when no view had a usable texel.
  double Power() const;

 private:
  SamplePlane plane_;
  LightFalloff falloff_;
  int columns_, rows_;
  std::vector<float> smallest_;  // per grid point; infinity: not seen
};

}  // namespace glint
