// Flat things strewn at random: leaves, blades, chips, strokes of a brush.
#pragma once

#include <cstdint>

#include "datasets/procedural/layers.h"

namespace glint::procedural {

struct ScatterOptions {
  float frequency = 8.0f;     // cells per unit; about one thing a cell
  float half_length = 0.9f;   // in cells, at most 1
  float half_width = 0.3f;    // in cells, at most half_length
  float square = 0.0f;        // outline: 0 pointed at both ends as a leaf, 1 a rectangle
  float presence = 1.0f;      // part of the cells that holds one
  float angle_turns = 0.0f;   // of the long axis
  float angle_spread = 1.0f;  // turns about it; 1: any
  uint32_t seed = 0;
};

struct ScatterRows {
  float* u;      // along the uppermost thing, −1 … 1
  float* v;      // across it, −1 … 1
  float* inset;  // 0 on its outline, up to 1 within; negative where nothing lies
  uint32_t* id;  // its hash, which also decides what lies above what
};

ScatterRows TakeScatterRows(Scratch& scratch);
// `pixel`: spacing of texels; narrower things are widened to it.
void ScatterThings(const ScatterOptions& options, const float* x, const float* y, int n,
                   float pixel, const ScatterRows& out);

}  // namespace glint::procedural
