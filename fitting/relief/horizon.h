// Whether a relief stands between a texel and a light.
//
// A light at the elevation θ is hidden where somewhere on the way to it, at the distance s, the
// relief's height z(s) is above the ray z(0) + s·tan θ. Heights that follow from the normals of
// initial maps are uncertain: what they say of two points k texels apart is off by
//
//   σ_k² = (0.05² k + 0.02² k²) texel²,
//
// single texels' errors added up, and slopes that are off over longer distances. (Six synthetic
// domes under 60 lights, initial maps against the truth: 0.04 to 0.08 texel at k = 1, 0.11 to 0.24
// at 5, 0.37 to 0.67 at 20.)
#pragma once

#include "base/reflectance/view.h"
#include "fitting/relief/height_field.h"

namespace glint {

class Horizon {
 public:
  // `plane`: of as many texels as the field.
  Horizon(HeightField field, const SamplePlane& plane);

  // How probable it is that the relief hides a place on the sample from a light:
  // max_k Φ((z(k) − z(0) − s_k tan θ)/σ_k). Nothing stands beyond the field's border.
  double HiddenShare(double x_mm, double y_mm, const Vec3d& light_in_sample_mm) const;

  // Mean square of the slopes along one axis, between neighbouring texels.
  double slope_variance() const { return slope_variance_; }

 private:
  HeightField field_;
  double left_mm_, top_mm_;  // of the first texel's centre
  double highest_mm_;
  double slope_variance_;
};

}  // namespace glint
