// Noise over a whole picture with detail down to its texels, at the cost of little more than one
// octave: a sum of interpolated lattices, each twice as fine as the one before.
#pragma once

#include <cstdint>

#include "datasets/procedural/plane.h"

namespace glint::procedural {

struct DetailOptions {
  // Amplitude of a level over the coarser one's. Power falls with frequency as f^(2·log2(gain) −
  // 2): .7 leaves mostly large forms, 1 is alike at all scales, 2 is white noise. Levels beyond 256
  // cells a unit weaken further, so that the contrast of large pictures stays bounded.
  float gain = 1.0f;
  int coarsest = 3;   // level of 2^coarsest cells a unit; the finest has about a cell a texel
  int stretch_x = 0;  // levels by which the lattice is coarser along an axis: streaks
  int stretch_y = 0;
  uint32_t seed = 0;
};

// width × height values, rows from the top, mean about 0, standard deviation about 1 at 256 texels;
// a unit is the longer side. One seed shows the same forms at every resolution.
Plane DetailNoise(const DetailOptions& options, int width, int height);

// Mean of the values within about `radius` texels, by two running boxes either way; beyond the
// border its nearest value goes on. `plane` is width × height with `stride` values a row.
Plane Blurred(const float* plane, int width, int height, int stride, int radius);

}  // namespace glint::procedural
