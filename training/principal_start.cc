#include "training/principal_start.h"

#include <algorithm>
#include <stdexcept>
#include <vector>

#include "fitting/encoding/encoding.h"

namespace glint {
namespace {

using torch::Tensor;

constexpr double kLift = 2.0;
// What a unit of error in each channel counts when components are chosen.
constexpr double kImportance[kEncodedChannels] = {1, 1, 1, 1, 1, 1, 1.2, 1.6, 1.6};
constexpr double kBeforeTanh = 1.15;  // tanh shrinks what the linear part predicts

// [n, C, h, w] → rows of 2×2 blocks [n·h/2·w/2, 4·C], columns ordered (channel, dy, dx).
Tensor Blocks(const Tensor& x) {
  const auto n = x.size(0), c = x.size(1), h = x.size(2), w = x.size(3);
  return x.reshape({n, c, h / 2, 2, w / 2, 2}).permute({0, 2, 4, 1, 3, 5}).reshape({-1, 4 * c});
}

struct Level {
  Tensor mean;    // [4C] of the blocks
  Tensor basis;   // [4C, out], orthonormal columns, largest variance first
  Tensor spread;  // [out] standard deviations
};

Level Components(const Tensor& blocks, int64_t out) {
  Level level;
  level.mean = blocks.mean(0);
  const Tensor centred = blocks - level.mean;
  const Tensor covariance =
      centred.t().mm(centred).to(torch::kFloat64) / static_cast<double>(blocks.size(0));
  const auto [values, vectors] = torch::linalg_eigh(covariance);
  const int64_t kept = std::min(out, vectors.size(1));
  // More channels than components: the rest stays unused at first.
  level.basis = torch::zeros({blocks.size(1), out});
  level.spread = torch::full({out}, 1e-2);
  level.basis.slice(1, 0, kept) = vectors.flip(1).slice(1, 0, kept).to(torch::kFloat32);
  level.spread.slice(0, 0, kept) =
      values.flip(0).slice(0, 0, kept).clamp_min(1e-6).sqrt().to(torch::kFloat32);
  return level;
}

// Columns of `basis` as 4×4 kernels whose inner taps see the block.
Tensor EncoderKernel(const Tensor& basis) {
  const int64_t out = basis.size(1), in = basis.size(0) / 4;
  Tensor kernel = torch::zeros({out, in, 4, 4});
  kernel.slice(2, 1, 3).slice(3, 1, 3) = basis.t().reshape({out, in, 2, 2});
  return kernel;
}

// The map from components [in] back to blocks, in the order of Interleave's phases (network.cc):
// phase a holds row dy = 1 − a of a block, and sees its own coarse texel with tap a.
void DecoderKernel(const Tensor& back, const Tensor& offset, Tensor* kernel, Tensor* bias) {
  const int64_t c = back.size(0) / 4, in = back.size(1);
  *kernel = torch::zeros({4 * c, in, 2, 2});
  *bias = torch::zeros({4 * c});
  const Tensor by_place = back.reshape({c, 2, 2, in});
  const Tensor offset_by_place = offset.reshape({c, 2, 2});
  for (int a = 0; a < 2; ++a) {
    for (int b = 0; b < 2; ++b) {
      const int64_t first = (a * 2 + b) * c;
      kernel->slice(0, first, first + c).select(3, b).select(2, a) =
          by_place.select(1, 1 - a).select(1, 1 - b);
      bias->slice(0, first, first + c) = offset_by_place.select(1, 1 - a).select(1, 1 - b);
    }
  }
}

// Moves the code's normalisation into the encoder's last convolution.
void NormaliseByWeights(const Tensor& spread, AutoencoderNetwork* net) {
  net->encoder_weights.back() /= spread.view({-1, 1, 1, 1});
  net->encoder_biases.back() = -net->code_mean / spread;
  net->code_mean = torch::zeros_like(net->code_mean);
  net->code_variance = torch::ones_like(net->code_variance);
}

}  // namespace

AutoencoderNetwork StartFromPrincipalComponents(const NetworkChannels& channels,
                                                const Tensor& samples,
                                                Normalisation normalisation) {
  if (normalisation == Normalisation::kAll) {
    throw std::invalid_argument("principal components stand on levels that are not normalised");
  }
  torch::NoGradGuard no_gradient;
  AutoencoderNetwork net;
  net.channels = channels;
  net.normalisation = normalisation;
  net.decoder_weights.resize(kLevels);
  net.decoder_biases.resize(kLevels);
  const Tensor importance =
      torch::from_blob(const_cast<double*>(kImportance), {kEncodedChannels}, torch::kFloat64)
          .to(torch::kFloat32);
  Tensor features = samples * importance.view({1, -1, 1, 1});
  for (int i = 0; i < kLevels; ++i) {
    const bool first = i == 0, last = i == kLevels - 1;
    const Tensor blocks = Blocks(features);
    const Level level = Components(blocks, channels[i]);
    const Tensor lift = last ? torch::zeros_like(level.spread) : kLift * level.spread;
    const Tensor offset = lift - level.mean.matmul(level.basis);

    const Tensor weigh = first ? importance.repeat_interleave(4) : torch::ones({blocks.size(1)});
    net.encoder_weights.push_back(EncoderKernel(level.basis * weigh.view({-1, 1})));
    net.encoder_biases.push_back(last ? torch::zeros_like(lift) : offset);
    // The last level's bias is left to the normalisation.
    const Tensor scale = last ? level.spread : torch::ones_like(level.spread);
    const Tensor undo = first ? kBeforeTanh / weigh : weigh;
    const Tensor back = level.basis * scale.view({1, -1}) * undo.view({-1, 1});
    const Tensor back_offset = (level.mean - level.basis.matmul(lift)) * undo;
    const int d = kLevels - 1 - i;
    DecoderKernel(back, back_offset, &net.decoder_weights[d], &net.decoder_biases[d]);

    if (last) {
      net.code_mean = level.mean.matmul(level.basis);
      net.code_variance = level.spread.square();
      if (normalisation == Normalisation::kNone) NormaliseByWeights(level.spread, &net);
    } else {
      const auto n = features.size(0), h = features.size(2) / 2, w = features.size(3) / 2;
      features = at::leaky_relu(blocks.matmul(level.basis) + offset, 0.2)
                     .reshape({n, h, w, channels[i]})
                     .permute({0, 3, 1, 2});
    }
  }
  return net;
}

}  // namespace glint
