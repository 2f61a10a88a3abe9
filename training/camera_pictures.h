// What cameras make of radiance, and what relief does to it, in tensor operations on any device.
// None of it waits for the device. Include from .cc files only: pulls in torch.
//
// Pictures are [B, N, 3, H, W], linear; what belongs to captures or shots is [B, N, 1, 1, 1] or
// [B, 1, 1, 1, 1].
#pragma once

#include <torch/torch.h>

namespace glint {

// Undoes sRGB's curve nearly; photographs are linearised with it.
inline constexpr double kPhotographGamma = 2.2;

// The heights whose slopes are nearest those of encoded maps [B, 9, H, W]: [B, 1, H, W] in texels,
// towards the viewer, mean 0, at most ±kMostHeight. The crop is continued periodically. Source:
// Frankot and Chellappa 1988.
torch::Tensor HeightsOf(const torch::Tensor& encoded);
inline constexpr double kMostHeight = 6;

// Share of the light that reaches each texel past the relief, [B, N, 1, H, W]: heights [B, 1, H, W]
// in texels; `light` [B, N, 3, H, W], unit directions to it.
torch::Tensor LitShare(const torch::Tensor& heights, const torch::Tensor& light);

// Pictures looked up `columns` to the right and `rows` below each texel ([B, N, 1, H, W]),
// bilinearly; border texels continue.
torch::Tensor Displaced(const torch::Tensor& pictures, const torch::Tensor& columns,
                        const torch::Tensor& rows);

// Each texel with `weight` of each of its four neighbours.
torch::Tensor Blurred(const torch::Tensor& pictures, const torch::Tensor& weight);

// Radiance through a tone curve whose toe leaves half of `toe`: x² / (x + toe). 0: unchanged.
torch::Tensor Crushed(const torch::Tensor& pictures, const torch::Tensor& toe);

// Encoded by x^(1/gamma), clipped, rounded to 8 bits.
torch::Tensor EncodedIn8Bits(const torch::Tensor& pictures, const torch::Tensor& gamma);

// 8-bit pictures in [0, 1] after JPEG of `quality` (50 to 100): quantised coefficients of the 8 × 8
// cosine transform in YCbCr with half as many chroma samples either way, tables of the standard's
// Annex K scaled as libjpeg scales them. H and W are multiples of 16.
torch::Tensor AfterJpeg(const torch::Tensor& pictures, const torch::Tensor& quality);

}  // namespace glint
