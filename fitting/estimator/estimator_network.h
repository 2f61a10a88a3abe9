// The single-photo estimator as torch modules. Include from .cc files only: this header pulls in
// torch.
//
// Role and shape after Deschaintre et al. 2018 (a U-Net with a track of global features beside it,
// fed back at every level, so that a texel far from the highlight knows of it). Its global track
// starts from the photograph's profile (photograph_features.h), which already says where and how
// high the highlight is. Fully convolutional: any size, multiples of 32 inside.
#pragma once

#include <torch/torch.h>

#include <array>
#include <vector>

#include "fitting/weights/tensor_records.h"

namespace glint {

inline constexpr int kEstimatorLevels = 5;
inline constexpr int kEstimatorDownsampling = 32;

struct EstimatorChannels {
  std::array<int, kEstimatorLevels> levels{24, 48, 96, 160, 256};
  int full = 16;     // at the photograph's own resolution
  int global = 128;  // of the global track
};

struct EstimatorNetwork {
  EstimatorChannels channels;
  std::vector<torch::Tensor> down_weights, down_biases;      // [out, in, 4, 4]
  std::vector<torch::Tensor> up_weights, up_biases;          // [4·out, in, 2, 2]
  std::vector<torch::Tensor> global_weights, global_biases;  // [global, in]
  std::vector<torch::Tensor> feed_weights;                   // [level's channels, global]
  std::vector<torch::Tensor> full_weights, full_biases;      // two 3×3 convolutions
  torch::Tensor final_feed;                                  // [9, global]

  // Weights drawn for `seed`; diffuse starts as what a matte, flat texel's would be.
  static EstimatorNetwork Random(const EstimatorChannels& channels, std::uint64_t seed);

  NamedTensors State();  // all learned

  // features [B, 11, H, W] and profile [B, 72] → encoded maps [B, 9, H, W] in [−1, 1], float32.
  torch::Tensor Forward(const torch::Tensor& features, const torch::Tensor& profile,
                        torch::Dtype compute) const;
};

EstimatorNetwork Clone(EstimatorNetwork* network);

}  // namespace glint
