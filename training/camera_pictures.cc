#include "training/camera_pictures.h"

#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "fitting/encoding/encoding.h"
#include "fitting/layers/staging.h"

namespace glint {
namespace {

using torch::Tensor;
namespace F = torch::nn::functional;

constexpr int64_t kBlock = 8;
constexpr double kMostCode = 255;

// `pictures` [M, C, H, W] at texels (x, y) [M or 1, H, W], counted from the first one's centre.
Tensor LookedUp(const Tensor& pictures, const Tensor& x, const Tensor& y) {
  const auto normalised = [](const Tensor& t, int64_t size) {
    return (t + 0.5) * (2.0 / static_cast<double>(size)) - 1;
  };
  const Tensor grid = torch::stack(
      torch::broadcast_tensors({normalised(x, pictures.size(3)), normalised(y, pictures.size(2))}),
      3);
  return F::grid_sample(
      pictures, grid, F::GridSampleFuncOptions().padding_mode(torch::kBorder).align_corners(false));
}

Tensor Columns(const Tensor& like) {
  return torch::arange(like.size(-1), like.options()).view({1, 1, -1});
}

Tensor Rows(const Tensor& like) {
  return torch::arange(like.size(-2), like.options()).view({1, -1, 1});
}

// The standard's example tables, Annex K.1 and K.2.
constexpr std::array<double, kBlock * kBlock> kLuma{
    16, 11, 10, 16, 24,  40,  51,  61,  12, 12, 14, 19, 26,  58,  60,  55,  //
    14, 13, 16, 24, 40,  57,  69,  56,  14, 17, 22, 29, 51,  87,  80,  62,  //
    18, 22, 37, 56, 68,  109, 103, 77,  24, 35, 55, 64, 81,  104, 113, 92,  //
    49, 64, 78, 87, 103, 121, 120, 101, 72, 92, 95, 98, 112, 100, 103, 99};
constexpr std::array<double, kBlock * kBlock> kChroma{
    17, 18, 24, 47, 99, 99, 99, 99, 18, 21, 26, 66, 99, 99, 99, 99,  //
    24, 26, 56, 99, 99, 99, 99, 99, 47, 66, 99, 99, 99, 99, 99, 99,  //
    99, 99, 99, 99, 99, 99, 99, 99, 99, 99, 99, 99, 99, 99, 99, 99,  //
    99, 99, 99, 99, 99, 99, 99, 99, 99, 99, 99, 99, 99, 99, 99, 99};

// Orthonormal; row k holds the k-th cosine.
Tensor CosineTransform(const torch::TensorOptions& options) {
  std::vector<double> values;
  for (int64_t k = 0; k < kBlock; ++k) {
    for (int64_t x = 0; x < kBlock; ++x) {
      const double scale = std::sqrt((k == 0 ? 1.0 : 2.0) / kBlock);
      values.push_back(scale * std::cos((2 * static_cast<double>(x) + 1) * static_cast<double>(k) *
                                        std::numbers::pi / (2 * kBlock)));
    }
  }
  return Staged(values, {kBlock, kBlock}, options);
}

// Planes [B, M, H, W] of values around 0 with their coefficients rounded to multiples of `table`
// [B, 1, 1, 1, 8, 8].
Tensor Quantised(const Tensor& planes, const Tensor& table) {
  const Tensor transform = CosineTransform(planes.options());
  const int64_t b = planes.size(0), m = planes.size(1), h = planes.size(2), w = planes.size(3);
  const Tensor blocks =
      planes.reshape({b, m, h / kBlock, kBlock, w / kBlock, kBlock}).transpose(3, 4);
  const Tensor coefficients = torch::matmul(torch::matmul(transform, blocks), transform.t());
  const Tensor rounded = (coefficients / table).round() * table;
  return torch::matmul(torch::matmul(transform.t(), rounded), transform)
      .transpose(3, 4)
      .reshape({b, m, h, w});
}

// libjpeg's tables of a quality of 50 or more.
Tensor ScaledTable(std::span<const double> base, const Tensor& quality) {
  const Tensor table = Staged(base, {1, 1, 1, 1, kBlock, kBlock}, quality.options());
  const Tensor percent = (200 - 2 * quality).view({-1, 1, 1, 1, 1, 1});
  return ((table * percent + 50) / 100).floor().clamp(1, kMostCode);
}

}  // namespace

Tensor HeightsOf(const Tensor& encoded) {
  TORCH_CHECK(encoded.size(3) % 2 == 0,
              "heights: found an odd width, of which a transform of real "
              "values does not give back the size");
  const Tensor t = encoded.slice(1, kEncodedNormal, kEncodedChannels);
  const Tensor slopes = t + 3 * t * t * t;  // encoding.h; n_x / n_z = −∂z/∂x, rows run to −y
  const Tensor p = torch::fft::rfft2(-slopes.select(1, 0));
  const Tensor q = torch::fft::rfft2(slopes.select(1, 1));
  const int64_t h = encoded.size(2), w = encoded.size(3);
  const Tensor u = 2 * std::numbers::pi * torch::fft::rfftfreq(w, encoded.options()).view({1, -1});
  const Tensor v = 2 * std::numbers::pi * torch::fft::fftfreq(h, encoded.options()).view({-1, 1});
  // −i·(u·p + v·q) / (u² + v²), by real and imaginary parts; 0 where u = v = 0.
  const Tensor scale = 1 / (u.square() + v.square()).clamp_min(1e-12);
  const Tensor sum =
      (torch::view_as_real(p) * u.unsqueeze(-1) + torch::view_as_real(q) * v.unsqueeze(-1)) *
      scale.unsqueeze(-1);
  const Tensor turned = torch::stack({sum.select(-1, 1), -sum.select(-1, 0)}, -1);
  const Tensor heights = torch::fft::irfft2(torch::view_as_complex(turned.contiguous()));
  return heights.unsqueeze(1).clamp(-kMostHeight, kMostHeight);
}

Tensor LitShare(const Tensor& heights, const Tensor& light) {
  constexpr int kSteps = 6;
  constexpr double kSoftness = 0.5;  // height over the ray at which a shadow is full, in texels
  const int64_t b = light.size(0), n = light.size(1);
  const Tensor up = light.slice(2, 2, 3).clamp_min(0.1);
  const Tensor by_x =
      (light.slice(2, 0, 1) / up).flatten(0, 2);  // texels aside per texel of height
  const Tensor by_row = (-light.slice(2, 1, 2) / up).flatten(0, 2);
  const Tensor ground =
      heights.unsqueeze(1).expand({-1, n, -1, -1, -1}).reshape({b * n, 1, heights.size(2), -1});
  const Tensor column = Columns(ground), row = Rows(ground);
  Tensor most = torch::zeros_like(ground);
  for (int k = 1; k <= kSteps; ++k) {
    // From the texel up to the highest ground that there may be, in rising steps.
    const double rise = kMostHeight * std::pow(static_cast<double>(k) / kSteps, 2);
    const Tensor there = LookedUp(ground, column + rise * by_x, row + rise * by_row);
    most = torch::maximum(most, there - ground - rise);
  }
  return (1 - (most / kSoftness).clamp(0, 1)).view({b, n, 1, heights.size(2), heights.size(3)});
}

Tensor Displaced(const Tensor& pictures, const Tensor& columns, const Tensor& rows) {
  return LookedUp(pictures.flatten(0, 1), Columns(pictures) + columns.flatten(0, 2),
                  Rows(pictures) + rows.flatten(0, 2))
      .view(pictures.sizes());
}

Tensor Blurred(const Tensor& pictures, const Tensor& weight) {
  const Tensor flat = pictures.flatten(0, 1);
  const int64_t height = flat.size(2), width = flat.size(3);
  const Tensor wide = torch::replication_pad2d(flat, {1, 1, 1, 1});
  const auto part = [&](int64_t row, int64_t column) {
    return wide.slice(2, row, row + height).slice(3, column, column + width);
  };
  const Tensor sum = (part(0, 1) + part(2, 1) + part(1, 0) + part(1, 2)).view(pictures.sizes());
  return (1 - 4 * weight) * pictures + weight * sum;
}

Tensor Crushed(const Tensor& pictures, const Tensor& toe) {
  constexpr double kLeast = 1e-9;  // against 0 / 0
  const Tensor x = pictures.clamp_min(0);
  return x.square() / (x + toe + kLeast);
}

Tensor EncodedIn8Bits(const Tensor& pictures, const Tensor& gamma) {
  return (pictures.clamp(0, 1).pow(1 / gamma) * kMostCode).round() / kMostCode;
}

Tensor AfterJpeg(const Tensor& pictures, const Tensor& quality) {
  TORCH_CHECK(pictures.size(3) % 16 == 0 && pictures.size(4) % 16 == 0,
              "JPEG: found a size that is no multiple of 16");
  const Tensor r = pictures.select(2, 0) * kMostCode, g = pictures.select(2, 1) * kMostCode,
               b = pictures.select(2, 2) * kMostCode;
  const Tensor y = 0.299 * r + 0.587 * g + 0.114 * b - 128;
  const auto chroma = [&](const Tensor& difference) {
    const Tensor coarse = torch::avg_pool2d(difference, 2);
    const Tensor quantised = Quantised(coarse, ScaledTable(kChroma, quality));
    return torch::upsample_nearest2d(quantised, {difference.size(2), difference.size(3)});
  };
  const Tensor luma = Quantised(y, ScaledTable(kLuma, quality)) + 128;
  const Tensor cb = chroma((b - y - 128) * 0.564), cr = chroma((r - y - 128) * 0.713);
  const Tensor rgb =
      torch::stack({luma + 1.402 * cr, luma - 0.344 * cb - 0.714 * cr, luma + 1.772 * cb}, 2);
  return rgb.round().clamp(0, kMostCode) / kMostCode;
}

}  // namespace glint
