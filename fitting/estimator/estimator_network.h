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

  // Weights drawn for `seed`; diffuse starts as what a matte, flat texel's would be.
  static EstimatorNetwork Random(const EstimatorChannels& channels, std::uint64_t seed,
                                 EstimatorKind kind = EstimatorKind::kPooled);

  NamedTensors State();  // all learned

  // features [B, N, 11, H, W] and profiles [B, N, 72] of the N photographs of B samples, and what
  // is known of each capture, [B, 2] (estimator_conditions.h).
  EstimatorOutput Forward(const torch::Tensor& features, const torch::Tensor& profiles,
                          const torch::Tensor& conditions, torch::Dtype compute) const;

  // The global features alone, after each level: [B·N, global]. Arguments as Forward()'s.
  std::vector<torch::Tensor> Global(const torch::Tensor& features, const torch::Tensor& profiles,
                                    const torch::Tensor& conditions, torch::Dtype compute) const;
  // Forward() with global features that are given, such as those of the same photographs at the
  // size that training showed: means over a picture are then what the network knows, and only what
  // is local depends on the resolution. `features` of any size, without gradient; works band by
  // band at full resolution.
  EstimatorOutput ForwardWithGlobal(const torch::Tensor& features,
                                    const std::vector<torch::Tensor>& global,
                                    torch::Dtype compute) const;

 private:
  // Of B·N photographs: what each level gives to the decoder, and the global features after it.
  struct Codes {
    std::vector<torch::Tensor> levels, global;
  };
  Codes Encode(const torch::Tensor& features, const torch::Tensor& first_global,
               const std::vector<torch::Tensor>* global, torch::Dtype compute) const;
  // Up to the photographs' resolution: [B, full, H, W].
  torch::Tensor Decode(const Codes& codes, torch::Dtype compute) const;
  // The last convolutions, of some rows: [B, 18, h, W] before the output's nonlinearity.
  torch::Tensor FullResolution(const torch::Tensor& features, const torch::Tensor& decoded,
                               torch::Dtype compute) const;
  EstimatorOutput Output(const torch::Tensor& features, const torch::Tensor& full,
                         const torch::Tensor& global, torch::Dtype compute) const;
  // Over the photographs, as the network's kind does it; `part` counts the levels, then full
  // resolution, then the global track. [B·N, C, …] → [B, 2·C, …]
  torch::Tensor Pool(const torch::Tensor& x, int64_t photographs, size_t part) const;
};

EstimatorNetwork Clone(EstimatorNetwork* network);

}  // namespace glint
