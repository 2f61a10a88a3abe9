// Captures of encoded maps for the estimator's training. Include from .cc files only: pulls in
// torch.
//
// A capture is N photographs of one crop, taken as the whole sample of [−1, 1]², a part or a
// multiple of it. Its geometry is one of three kinds, its disturbances have a size of their own, so
// that clean captures occur beside bad ones (capture_draw.h). The host draws numbers and hands them
// to the device; it does not wait for it.
#pragma once

#include <torch/torch.h>

#include <array>

#include "training/random.h"

namespace glint {

struct CaptureBatch {
  torch::Tensor features;    // [B, N, 11, S, S]
  torch::Tensor profiles;    // [B, N, 72]
  torch::Tensor conditions;  // [B, 2] (estimator_conditions.h)
};

enum class CaptureQuality {
  kDrawn,  // geometries, exposures and disturbances as real captures have them
  kClean   // DIR 2019's geometry, rightly exposed, 8 bits: for validation
};

// `photographs` of each of the maps [B, 9, S, S], drawn from `random`, on the maps' device.
CaptureBatch PhotographMaps(const torch::Tensor& encoded, int photographs, CaptureQuality quality,
                            Stream* random);

// How many photographs the samples of a batch have; each entry is as probable as the others. One
// photograph is the hardest and the most usual; 7 and 9 are what real sets have.
inline constexpr std::array<int, 10> kPhotographCounts = {1, 1, 1, 2, 2, 3, 4, 5, 7, 9};

}  // namespace glint
