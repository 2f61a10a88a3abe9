#include "fitting/autoencoder/network.h"

#include <cmath>
#include <functional>
#include <stdexcept>

#include "fitting/encoding/encoding.h"
#include "fitting/layers/layers.h"

namespace glint {
namespace {

using torch::Tensor;

constexpr double kNormEpsilon = 1e-5;
constexpr int kInnerLevels = kLevels - 1;  // convolutions of each half that another one follows

// Normalises x [B, C, H, W] by statistics [C].
Tensor ByStatistics(const Tensor& x, const Tensor& mean, const Tensor& variance) {
  const Tensor scale = torch::rsqrt(variance + kNormEpsilon);
  return (x - mean.view({1, -1, 1, 1}).to(x.scalar_type())) *
         scale.view({1, -1, 1, 1}).to(x.scalar_type());
}

Tensor ByBatch(const Tensor& x, const Tensor& mean, const Tensor& variance, double momentum) {
  return at::batch_norm(x.to(torch::kFloat32), {}, {}, mean, variance, true, momentum, kNormEpsilon,
                        false)
      .to(x.scalar_type());
}

// What is done to the output of inner convolution k, encoder's first.
using InnerStep = std::function<Tensor(const Tensor& x, int k)>;

Tensor RunEncoder(const AutoencoderNetwork& net, const Tensor& encoded, torch::Dtype compute,
                  const InnerStep& inner) {
  Tensor x = AsType(encoded, compute);
  for (int i = 0; i < kLevels; ++i) {
    x = DownConvolve(x, net.encoder_weights[i], net.encoder_biases[i], compute);
    if (i < kInnerLevels) x = at::leaky_relu(inner(x, i), kLeak);
  }
  return x.to(encoded.scalar_type());
}

Tensor RunDecoder(const AutoencoderNetwork& net, const Tensor& z, torch::Dtype compute,
                  const InnerStep& inner) {
  Tensor x = AsType(z, compute);
  for (int i = 0; i < kLevels; ++i) {
    x = UpConvolve(x, net.decoder_weights[i], net.decoder_biases[i], compute);
    if (i < kInnerLevels) x = at::leaky_relu(inner(x, kInnerLevels + i), kLeak);
  }
  return at::tanh(x.to(z.scalar_type()));
}

InnerStep RunningStep(const AutoencoderNetwork& net) {
  return [&net](const Tensor& x, int k) {
    return net.level_means.empty() ? x
                                   : ByStatistics(x, net.level_means[static_cast<size_t>(k)],
                                                  net.level_variances[static_cast<size_t>(k)]);
  };
}

InnerStep BatchStep(const AutoencoderNetwork& net, double momentum) {
  return [&net, momentum](const Tensor& x, int k) {
    return net.level_means.empty() ? x
                                   : ByBatch(x, net.level_means[static_cast<size_t>(k)],
                                             net.level_variances[static_cast<size_t>(k)], momentum);
  };
}

}  // namespace

std::string_view NormalisationName(Normalisation normalisation) {
  return normalisation == Normalisation::kNone  ? "none"
         : normalisation == Normalisation::kAll ? "all"
                                                : "code";
}

Normalisation ParseNormalisation(const std::string& name) {
  for (const auto n : {Normalisation::kNone, Normalisation::kCode, Normalisation::kAll}) {
    if (name == NormalisationName(n)) return n;
  }
  throw std::runtime_error("normalisation: found \"" + name + "\"; use none, code or all");
}

AutoencoderNetwork AutoencoderNetwork::Random(const NetworkChannels& channels, std::uint64_t seed,
                                              Normalisation normalisation) {
  torch::Generator generator = torch::make_generator<torch::CPUGeneratorImpl>(seed);
  AutoencoderNetwork net;
  net.channels = channels;
  net.normalisation = normalisation;
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
  for (int k = 0; normalisation == Normalisation::kAll && k < 2 * kInnerLevels; ++k) {
    const int count = channels[k < kInnerLevels ? k : 2 * kInnerLevels - 1 - k];
    net.level_means.push_back(torch::zeros({count}));
    net.level_variances.push_back(torch::ones({count}));
  }
  return net;
}

NamedTensors AutoencoderNetwork::Parameters() {
  NamedTensors list;
  const auto add = [&](const char* part, std::vector<Tensor>* weights,
                       std::vector<Tensor>* biases) {
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
  const size_t levels = normalisation == Normalisation::kAll ? 2 * kInnerLevels : 0;
  level_means.resize(levels);
  level_variances.resize(levels);
  for (size_t k = 0; k < levels; ++k) {
    list.emplace_back("level." + std::to_string(k) + ".mean", &level_means[k]);
    list.emplace_back("level." + std::to_string(k) + ".variance", &level_variances[k]);
  }
  return list;
}

Tensor AutoencoderNetwork::EncodeRaw(const Tensor& encoded, torch::Dtype compute) const {
  return RunEncoder(*this, encoded, compute, RunningStep(*this));
}

Tensor AutoencoderNetwork::EncodeForTraining(const Tensor& encoded, torch::Dtype compute,
                                             double momentum) {
  const Tensor raw = RunEncoder(*this, encoded, compute, BatchStep(*this, momentum));
  return normalisation == Normalisation::kNone ? raw : NormaliseForTraining(raw, momentum);
}

Tensor AutoencoderNetwork::DecodeForTraining(const Tensor& z, torch::Dtype compute,
                                             double momentum) {
  return RunDecoder(*this, z, compute, BatchStep(*this, momentum));
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
  return normalisation == Normalisation::kNone ? raw : ByStatistics(raw, code_mean, code_variance);
}

Tensor AutoencoderNetwork::Decode(const Tensor& z, torch::Dtype compute) const {
  return RunDecoder(*this, z, compute, RunningStep(*this));
}

AutoencoderNetwork Clone(AutoencoderNetwork* network) {
  AutoencoderNetwork copy;
  copy.channels = network->channels;
  copy.normalisation = network->normalisation;
  CopyTensors(network->State(), copy.State());
  return copy;
}

}  // namespace glint
