// The renderings that the auto-encoder's loss compares (DIR 2019, section 4.2), their geometry.
#pragma once

#include <vector>

#include "base/reflectance/view.h"
#include "training/random.h"

namespace glint {

// `count` views of the plane [−1, 1]² (in mm): the first third (rounded up) with cosine-distributed
// directions of light and camera, the others with the camera in the mirror direction of the light
// about a random point of the plane, so that the highlight is there. Log-distances ~ N(0.5, 0.75²),
// cut to [0.7, 8]. E = π without falloff.
std::vector<View> DrawRenderLossViews(Stream* random, int count);

}  // namespace glint
