#include "fitting/autoencoder/network.h"

#include <cmath>

#include "fitting/encoding/encoding.h"
#include "fitting/layers/layers.h"

namespace glint {
namespace {

using torch::Tensor;

constexpr double kNormEpsilon = 1e-5;

}  // namespace

AutoencoderNetwork AutoencoderNetwork::Random(const NetworkChannels& channels,
                                              std::uint64_t seed) {
  torch::Generator generator = torch::make_generator<torch::CPUGeneratorImpl>(seed);
  AutoencoderNetwork net;
  net.channels = channels;
  for (int i = 0; i < kLevels; ++i) {
    const int in = i == 0 ? kEncodedChannels : channels[i - 1];
    const double scale = std::sqrt(2.0 / (in * 16.0));
    net.encoder_weights.push_back(torch::randn({channels[i], in, 4, 4}, generator) * scale);
    net.encoder_biases.push_back(torch::zeros({channels[i]}));
  }
  for (int i = 0; i < kLevels; ++i) {
    const int in = channels[kLevels - 1 - i];
    const int out = i == kLevels - 1 ? kEncodedChannels : channels[kLevels - 2 - i];
    const double scale = std::sqrt(2.0 / (in * 9.0)) * (i == kLevels - 1 ? 0.25 : 0.75);
    net.decoder_weights.push_back(PhaseKernels(torch::randn({out, in, 3, 3}, generator) * scale));
    net.decoder_biases.push_back(torch::zeros({4 * out}));
  }
  net.code_mean = torch::zeros({channels[kLevels - 1]});
  net.code_variance = torch::ones({channels[kLevels - 1]});
  return net;
}

NamedTensors AutoencoderNetwork::Parameters() {
  NamedTensors list;
  const auto add = [&](const char* part, std::vector<Tensor>* weights, std::vector<Tensor>* biases) {
    weights->resize(kLevels);
    biases->resize(kLevels);
    for (int i = 0; i < kLevels; ++i) {
      const std::string stem = std::string(part) + "." + std::to_string(i);
      list.emplace_back(stem + ".weight", &(*weights)[i]);
      list.emplace_back(stem + ".bias", &(*biases)[i]);
    }
  };
  add("encoder", &encoder_weights, &encoder_biases);
  add("decoder", &decoder_weights, &decoder_biases);
  return list;
}

NamedTensors AutoencoderNetwork::State() {
  auto list = Parameters();
  list.emplace_back("code.mean", &code_mean);
  list.emplace_back("code.variance", &code_variance);
  return list;
}

Tensor AutoencoderNetwork::EncodeRaw(const Tensor& encoded, torch::Dtype compute) const {
  Tensor x = AsType(encoded, compute);
  for (int i = 0; i < kLevels; ++i) {
    if (i > 0) x = at::leaky_relu(x, kLeak);
    x = DownConvolve(x, encoder_weights[i], encoder_biases[i], compute);
  }
  return x.to(encoded.scalar_type());
}

Tensor AutoencoderNetwork::NormaliseForTraining(const Tensor& raw, double momentum) {
  Tensor scale, shift;
  {
    torch::NoGradGuard no_gradient;
    const auto [variance, mean] = torch::var_mean(raw, {0, 2, 3}, false);
    const Tensor running = torch::rsqrt(code_variance + kNormEpsilon);
    scale = (torch::sqrt(variance + kNormEpsilon) * running).view({1, -1, 1, 1});
    shift = ((mean - code_mean) * running).view({1, -1, 1, 1});
  }
  const Tensor by_batch =
      at::batch_norm(raw, {}, {}, code_mean, code_variance, true, momentum, kNormEpsilon, false);
  return by_batch * scale + shift;
}

Tensor AutoencoderNetwork::NormaliseByRunning(const Tensor& raw) const {
  const Tensor mean = code_mean.view({1, -1, 1, 1});
  const Tensor scale = torch::rsqrt(code_variance + kNormEpsilon).view({1, -1, 1, 1});
  return (raw - mean) * scale;
}

Tensor AutoencoderNetwork::Decode(const Tensor& z, torch::Dtype compute) const {
  Tensor x = AsType(z, compute);
  for (int i = 0; i < kLevels; ++i) {
    if (i > 0) x = at::leaky_relu(x, kLeak);
    x = UpConvolve(x, decoder_weights[i], decoder_biases[i], compute);
  }
  return at::tanh(x.to(z.scalar_type()));
}

}  // namespace glint
