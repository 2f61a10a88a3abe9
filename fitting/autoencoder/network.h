// The auto-encoder as torch modules. Include from .cc files only: this header pulls in torch.
//
// Source: Gao et al. 2019 (DIR), Fig. 3 and its published code. Differences: the up-convolutions
// are computed by ordinary ones (fitting/layers), and the code enters the decoder's first
// convolution as it is, without a LeakyReLU, so that training can start from a linear auto-encoder
// (training/principal_start.h).
#pragma once

#include <torch/torch.h>

#include <array>
#include <string>
#include <string_view>
#include <vector>

#include "fitting/weights/tensor_records.h"

namespace glint {

inline constexpr int kLevels = 5;
inline constexpr int kDownsampling = 32;

// Channels after each of the encoder's convolutions; the decoder runs through them backwards. The
// last is the latent code's.
using NetworkChannels = std::array<int, kLevels>;

// Where batch normalisation (scale 1, bias 0) stands: nowhere, on the code alone as in the paper,
// or after every convolution but the last as well (the paper's ablation, Fig. 4).
enum class Normalisation { kNone, kCode, kAll };

std::string_view NormalisationName(Normalisation normalisation);  // "none", "code", "all"
// Throws std::runtime_error for other names.
Normalisation ParseNormalisation(const std::string& name);

struct AutoencoderNetwork {
  NetworkChannels channels{};
  Normalisation normalisation = Normalisation::kCode;
  std::vector<torch::Tensor> encoder_weights, encoder_biases;  // [out, in, 4, 4]
  std::vector<torch::Tensor> decoder_weights, decoder_biases;  // [4·out, in, 2, 2]
  torch::Tensor code_mean, code_variance;  // batch normalisation's running values
  // The same of the other convolutions, encoder's first; empty unless normalisation is kAll.
  std::vector<torch::Tensor> level_means, level_variances;

  // Weights drawn for `seed` (He's variance; up-convolutions start as nearest-upsample + 3×3).
  static AutoencoderNetwork Random(const NetworkChannels& channels, std::uint64_t seed,
                                   Normalisation normalisation = Normalisation::kCode);

  // Learned tensors with their names in weights files, in a fixed order.
  NamedTensors Parameters();
  // Parameters and the code's running statistics.
  NamedTensors State();

  // `encoded` [B, 9, H, W], H and W multiples of 32 → code [B, C, H/32, W/32] before normalisation.
  // Convolutions run in `compute`; result in the type of `encoded`.
  torch::Tensor EncodeRaw(const torch::Tensor& encoded, torch::Dtype compute) const;

  // The code of a training step; the batch moves the running statistics by `momentum`.
  torch::Tensor EncodeForTraining(const torch::Tensor& encoded, torch::Dtype compute,
                                  double momentum);
  torch::Tensor DecodeForTraining(const torch::Tensor& z, torch::Dtype compute, double momentum);

  // Values normalised by the running statistics, which the batch then moves by `momentum`;
  // gradients those of batch normalisation. (Batch renormalisation, Ioffe 2017: a batch of few
  // crops has means of its own, and normalising by them would take the crops' very colour out of
  // the code.)
  torch::Tensor NormaliseForTraining(const torch::Tensor& raw, double momentum);
  torch::Tensor NormaliseByRunning(const torch::Tensor& raw) const;  // kNone: as it is

  // z [B, C, h, w] → encoded maps [B, 9, 32·h, 32·w] in [−1, 1], in z's type.
  torch::Tensor Decode(const torch::Tensor& z, torch::Dtype compute) const;
};

AutoencoderNetwork Clone(AutoencoderNetwork* network);

}  // namespace glint
