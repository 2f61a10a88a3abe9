// How much of the sky a point of a relief sees.
#pragma once

#include <vector>

#include "fitting/relief/height_field.h"

namespace glint {

struct OcclusionOptions {
  int directions = 16;  // azimuths along which the horizon is looked for
  double reach_mm = 0;  // how far; 0: an eighth of the shorter side
  // Steps along a direction grow with distance, so that near walls are met texel by texel.
  double step_growth = 1.15;
};

// Cosine-weighted share of the hemisphere above the sample's plane that no other point hides, 0 to
// 1, H·W: mean over azimuths of 1 − sin²(horizon's elevation) (Bavoil and Sainz, "Image-space
// horizon-based ambient occlusion", 2008). The relief continues as it ends. The same for any number
// of threads.
std::vector<float> AmbientOcclusion(const HeightField& field, const OcclusionOptions& options,
                                    int threads);

}  // namespace glint
