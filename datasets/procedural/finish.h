// What keeps a drawn surface from looking drawn: detail down to the texels, tied across colour,
// roughness and relief; crevices and ridges that dirt, wear and water find; and the low contrast of
// most real things.
#pragma once

#include <cstddef>
#include <cstdint>

#include "datasets/procedural/plane.h"

namespace glint::procedural {

// A picture's layers as whole planes, width × height, rows from the top; layers.h says what each
// holds. Heights are scaled so that their slope is the surface's, in units of the longer side, and
// have a border of one texel all around.
struct LayerPlanes {
  LayerPlanes(int width_in, int height_in);

  int width, height;
  Plane heights, r, g, b, metal, f0, roughness;

  int height_stride() const { return width + 2; }
  float* HeightRow(int row) {
    return heights.data() + (static_cast<size_t>(row) + 1) * height_stride() + 1;
  }
};

// Changes the planes as `seed` draws; some draws change little. `slope`: the relief's, root mean
// square.
void FinishSurface(uint64_t seed, float slope, LayerPlanes* planes);

// Factors by which a finished surface shows more of its pattern than a drawn one, along the
// pattern's axes, and by which its relief is flatter.
struct PatternScale {
  float x = 1.0f, y = 1.0f, relief = 1.0f;
};
PatternScale FinishScale(uint64_t seed);

}  // namespace glint::procedural
