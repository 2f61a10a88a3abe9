// The photographs that maps are fitted to, in memory: rectified, linear, with known geometry.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "base/reflectance/convention.h"
#include "base/reflectance/environment_lighting.h"
#include "base/reflectance/systematic_deviations.h"
#include "base/reflectance/view.h"

namespace glint {

struct Photograph {
  View view;
  bool ldr = true;              // clips at radiance 1
  std::vector<float> rgb;       // planar, 3·H·W, linear Rec.709
  std::vector<float> mask;      // H·W, 0 … 1; 0: the values may be anything
  double pixels_per_texel = 0;  // side of a texel in the picture that this was; 0: not known
  double blur_px = 0;           // of that picture, before it was resampled; 0: not known
  double hidden_variance = 0;   // of log radiance: detail that its blur hides and others show
  // Of its points as it is now, texels², where others lent it detail.
  std::optional<double> spread_variance = {};
};

struct PhotographSet {
  SamplePlane plane;
  ReflectanceConvention convention;
  bool light_power_known = true;    // false: light_rgb is a first guess up to one common factor
  EnvironmentLighting environment;  // beside what each view has as ambient light; refine finds it
  // Of the maps' errors that follow from what is uncertain about the views.
  SystematicDeviations systematic_sd;
  std::vector<Photograph> photographs;

  // Empty: all is well; otherwise what is wrong (sizes, no photograph, no usable texel).
  std::string Check() const;
};

// Rows first_row … first_row + rows − 1 of a photograph.
using ReadRows = std::function<Photograph(int first_row, int rows)>;

// Whether the sensor's limit was reached in a texel: radiance of an LDR photograph at its limit, or
// masked since a pixel under it is clipped (rectification keeps the radiance of such texels, which
// are bright; what lies outside of the picture or under the frame is dark or has a mask of its
// own). Such a texel is part of a highlight, not unknown: its radiance is a lower bound.
bool ReachesLimit(const Photograph& photograph, size_t texel);

// Area averages of the texels that say something. What is clipped stays clipped, as in a photograph
// that was rectified at the smaller size: a texel with a clipped part has its radiance, of the
// clipped part too, and is masked unless the average is at the limit. Elsewhere a texel's mask
// becomes the usable share of its area.
// width and height at most the set's. Works tile by tile; results do not depend on `threads`.
// Throws std::invalid_argument for other sizes.
PhotographSet Downsampled(const PhotographSet& set, int width, int height, int threads);
// The same of one photograph of the plane's size that need not be whole in memory.
Photograph DownsampledByRows(const ReadRows& read, const SamplePlane& plane, int width, int height,
                             int threads);

}  // namespace glint
