// The photographs that maps are fitted to, in memory: rectified, linear, with known geometry.
#pragma once

#include <string>
#include <vector>

#include "fitting/reflectance/convention.h"
#include "fitting/reflectance/room_light.h"
#include "fitting/reflectance/view.h"

namespace glint {

struct Photograph {
  View view;
  bool ldr = true;          // clips at radiance 1
  std::vector<float> rgb;   // planar, 3·H·W, linear Rec.709
  std::vector<float> mask;  // H·W, 0 … 1; 0: the values may be anything
};

struct PhotographSet {
  SamplePlane plane;
  ReflectanceConvention convention;
  bool light_power_known = true;  // false: light_rgb is a first guess up to one common factor
  RoomLight room;                 // beside what each view has as ambient light; refine finds it
  std::vector<Photograph> photographs;

  // Empty: all is well; otherwise what is wrong (sizes, no photograph, no usable texel).
  std::string Check() const;
};

// Area averages of the usable texels; a texel's mask becomes the usable share of its area.
// width and height at most the set's. Works tile by tile; results do not depend on `threads`.
PhotographSet Downsampled(const PhotographSet& set, int width, int height, int threads);

}  // namespace glint
