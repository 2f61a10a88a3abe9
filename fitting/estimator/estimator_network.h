// The SVBRDF estimator as torch modules: any number of photographs of one sample → maps and their
// uncertainty. Include from .cc files only: this header pulls in torch.
//
// A U-Net with a track of global features beside it, fed back at every level (Deschaintre et al.
// 2018), whose encoder runs once per photograph. What the decoder reads are mean and maximum over
// the photographs of each level's features (Deschaintre et al. 2019, "Flexible SVBRDF capture with
// a multi-image deep network"), so neither order nor number of photographs matters. The global
// track starts from each photograph's highlight profile (photograph_features.h) and from what is
// known of the capture beforehand. Each level has a residual convolution (He et al. 2016). Fully
// convolutional: any size, multiples of 32 inside.
#pragma once

#include <torch/torch.h>

#include <array>
#include <map>
#include <string>
#include <vector>

#include "fitting/estimator/estimator_descent.h"
#include "fitting/weights/tensor_records.h"

namespace glint {

inline constexpr int kEstimatorLevels = 5;
inline constexpr int kResidualUpLevels = kEstimatorLevels - 1;  // all but the finest
inline constexpr int kEstimatorDownsampling = 32;

struct EstimatorChannels {
  std::array<int, kEstimatorLevels> levels{32, 64, 128, 224, 320};
  int full = 24;     // at the photographs' own resolution
  int global = 192;  // of the global track
};

// Networks that can be trained; docs/experiments/training.md compares them.
enum class EstimatorKind {
  kPooled,    // mean and maximum over the photographs
  kAttended,  // two averages over the photographs, weighted by attention, instead
  kDescent    // kPooled, whose estimate is improved by a learned descent (estimator_descent.h)
};
// "pooled", "attended", "descent". Throws std::invalid_argument for another name.
std::string EstimatorKindName(EstimatorKind kind);
EstimatorKind ParseEstimatorKind(const std::string& name);

struct EstimatorOutput {
  torch::Tensor maps;       // [B, 9, H, W] encoded, in [−1, 1], float32
  torch::Tensor log_scale;  // [B, 9, H, W]: ln b, b the mean absolute error expected of `maps`
};

struct EstimatorNetwork {
  EstimatorChannels channels;
  EstimatorKind kind = EstimatorKind::kPooled;
  std::vector<torch::Tensor> down_weights, down_biases;  // [out, in, 4, 4]
  std::vector<torch::Tensor> up_weights, up_biases;      // [4·out, in, 2, 2]
  // 3×3 residual convolutions: [c, c, 3, 3].
  std::vector<torch::Tensor> down_residual_weights, down_residual_biases;
  std::vector<torch::Tensor> up_residual_weights,
      up_residual_biases;                                    // what level i + 1 gives to level i
  std::vector<torch::Tensor> global_weights, global_biases;  // [global, in]
  std::vector<torch::Tensor> feed_weights;                   // [level's channels, global]
  // 3×3 convolutions at full resolution: per photograph, and the decoder's last two.
  torch::Tensor photograph_weight, photograph_bias;
  std::vector<torch::Tensor> full_weights, full_biases;
  torch::Tensor final_feed;  // [18, 2·global]
  // kAttended: scores of a photograph's features, [2·heads, channels]: of the levels, at full
  // resolution, and of the global track.
  std::vector<torch::Tensor> attention_weights;
  DescentNetwork descent;  // kDescent
  // Whether the residual convolutions do anything: those of an adopted v1 file are 0.
  bool residual = true;

  // Weights drawn for `seed`; diffuse starts as what a matte, flat texel's would be.
  static EstimatorNetwork Random(const EstimatorChannels& channels, std::uint64_t seed,
                                 EstimatorKind kind = EstimatorKind::kPooled);

  // The network that a file of one photograph's estimator ("glint-estimator v1") describes: for one
  // photograph the same function, for several the decoder of their mean features. `v1` holds that
  // file's tensors by name.
  void AdoptSinglePhotograph(const std::map<std::string, torch::Tensor>& v1);

  NamedTensors State();  // all learned

  // features [B, N, 11, H, W] and profiles [B, N, 72] of the N photographs of B samples, and what
  // is known of each capture, [B, 2] (estimator_conditions.h).
  EstimatorOutput Forward(const torch::Tensor& features, const torch::Tensor& profiles,
                          const torch::Tensor& conditions, torch::Dtype compute) const;
};

EstimatorNetwork Clone(EstimatorNetwork* network);

}  // namespace glint
