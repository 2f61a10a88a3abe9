// The outermost texels of a sample.
#pragma once

#include "base/reflectance/svbrdf_maps.h"

namespace glint {

// What a photograph shows of the outermost texels mixes with what lies around the sample: half of
// such a texel may lie beyond its edge, and a photograph's pixels reach over it. Sets the outermost
// `rings` of texels to the nearest texel further in; fewer where the maps are not that large.
void ContinueBorder(SvbrdfMaps* maps, int rings);
// How many rings those are.
int BorderInset(int width, int height, int rings);

// For options that choose `rings`.
inline constexpr int kMostBorderRings = 64;

}  // namespace glint
