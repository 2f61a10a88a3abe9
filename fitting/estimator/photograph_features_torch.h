// photograph_features.h for batches, in torch operations on any device: what training shows the
// estimator. Include from .cc files only: pulls in torch.
#pragma once

#include <torch/torch.h>

#include "fitting/render/view_tensors.h"

namespace glint {

struct PhotographTensors {
  torch::Tensor radiance;  // [B, N, 3, H, W] linear; 0 where the mask is
  torch::Tensor mask;      // [B, N, 1, H, W], 1: usable, else 0
  torch::Tensor ldr;       // [B, N, 1, 1, 1], 1: clips at 1, else 0
};

struct FeatureTensors {
  torch::Tensor planes;    // [B, N, 11, H, W]
  torch::Tensor profiles;  // [B, N, 72]
};

// `believed`: the photographs' views as the estimator is told. The same values as FeaturesOf(), up
// to float's rounding, of photographs whose mask hides no clipped texel.
FeatureTensors FeaturesOfTensors(const PhotographTensors& photographs, const ViewTensors& believed,
                                 const SamplePlane& plane, LightFalloff falloff);

}  // namespace glint
