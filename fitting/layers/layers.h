// The convolutions that Glint's networks are made of. Include from .cc files only: pulls in torch.
//
// All tensors are [batch, channels, height, width] and channels-last in memory.
#pragma once

#include <torch/torch.h>

namespace glint {

// Slope of the networks' LeakyReLU below 0 (Gao et al. 2019, Fig. 3).
inline constexpr double kLeak = 0.2;

// `t` in another type, channels-last.
torch::Tensor AsType(const torch::Tensor& t, torch::Dtype type);

// 4×4 convolution of stride 2 in `compute`: [B, in, H, W] → [B, out, H/2, W/2].
torch::Tensor DownConvolve(const torch::Tensor& x, const torch::Tensor& weight,
                           const torch::Tensor& bias, torch::Dtype compute);

// 4×4 up-convolution of stride 2 in `compute`: [B, in, h, w] → [B, out, 2h, 2w]. bf16 needs
// ordinary convolutions, so it is computed as a 2×2 convolution to four times the channels
// (`weight` [4·out, in, 2, 2], channel = phase·out + k) whose results are interleaved (pixel
// shuffle) and cropped by one: the same linear map with the same number of multiplications.
torch::Tensor UpConvolve(const torch::Tensor& x, const torch::Tensor& weight,
                         const torch::Tensor& bias, torch::Dtype compute);

// UpConvolve's interleaving of `wide` [B, 4·out, h+1, w+1] by torch's own operations, as it is done
// on GPUs: [B, out, 2h, 2w].
torch::Tensor InterleavedByTorch(const torch::Tensor& wide);

// The up-convolution's weight that equals nearest upsampling followed by `kernel` [out, in, 3, 3].
torch::Tensor PhaseKernels(const torch::Tensor& kernel);

// bfloat16 on GPUs and where the CPU multiplies it natively (AVX512_BF16 or AMX), float32
// elsewhere.
torch::Dtype FastComputeType(torch::Device device = torch::kCPU);

}  // namespace glint
