#include "fitting/estimator/estimator_network.h"

#include <cmath>

#include "fitting/encoding/encoding.h"
#include "fitting/estimator/photograph_features.h"
#include "fitting/layers/layers.h"

namespace glint {
namespace {

using torch::Tensor;

// Means and spreads that bring the features near the range −1 … 1.
constexpr float kFeatureMean[kFeaturePlanes] = {0.5f, 0.5f, 0.5f, 0, 1, 0, 0, 0, 0, 0.35f, 0};
constexpr float kFeatureScale[kFeaturePlanes] = {2, 2, 2, 1, 1, 1.5f, 1.5f, 1.5f, 1.5f, 2.5f, 0.7f};
constexpr double kProfileScale = 0.4;
constexpr double kFirstRoughness = 0.1;  // of the tanh's argument: r about 0.55
constexpr double kFirstSpecular = -0.6;  // F0 about 0.05

Tensor Normalised(const Tensor& features) {
  const auto row = [](const float* values) {
    return torch::from_blob(const_cast<float*>(values), {1, kFeaturePlanes, 1, 1}).clone();
  };
  return (features - row(kFeatureMean)) * row(kFeatureScale);
}

// What level i's up-convolution reads: the level's own features, and for all but the deepest what
// came up from below.
int UpInput(const EstimatorChannels& c, int level) {
  return level == kEstimatorLevels - 1 ? c.levels[level] : 2 * c.levels[level];
}

int UpOutput(const EstimatorChannels& c, int level) {
  return level == 0 ? c.full : c.levels[level - 1];
}

Tensor Spread(const Tensor& global, const Tensor& weight) {
  return torch::matmul(global, weight.t()).unsqueeze(2).unsqueeze(3);
}

}  // namespace

EstimatorNetwork EstimatorNetwork::Random(const EstimatorChannels& channels, std::uint64_t seed) {
  torch::Generator generator = torch::make_generator<torch::CPUGeneratorImpl>(seed);
  const auto draw = [&](std::vector<int64_t> shape, double fan_in, double gain) {
    return torch::randn(shape, generator) * (gain * std::sqrt(2.0 / fan_in));
  };
  EstimatorNetwork net;
  net.channels = channels;
  for (int i = 0; i < kEstimatorLevels; ++i) {
    const int in = i == 0 ? kFeaturePlanes : channels.levels[i - 1], out = channels.levels[i];
    net.down_weights.push_back(draw({out, in, 4, 4}, in * 16.0, 1));
    net.down_biases.push_back(torch::zeros({out}));
    const int seen = out + (i == 0 ? kProfileValues : channels.global);
    net.global_weights.push_back(draw({channels.global, seen}, seen, 1));
    net.global_biases.push_back(torch::zeros({channels.global}));
    net.feed_weights.push_back(draw({out, channels.global}, channels.global, 0.3));
    const int up_in = UpInput(channels, i), up_out = UpOutput(channels, i);
    net.up_weights.push_back(PhaseKernels(draw({up_out, up_in, 3, 3}, up_in * 9.0, 0.75)));
    net.up_biases.push_back(torch::zeros({4 * up_out}));
  }
  const int in = channels.full + kFeaturePlanes;
  net.full_weights = {draw({channels.full, in, 3, 3}, in * 9.0, 1),
                      draw({kEncodedChannels, in, 3, 3}, in * 9.0, 0.1)};
  Tensor bias = torch::zeros({kEncodedChannels});
  bias.slice(0, kEncodedSpecular, kEncodedRoughness).fill_(kFirstSpecular);
  bias.slice(0, kEncodedRoughness, kEncodedNormal).fill_(kFirstRoughness);
  net.full_biases = {torch::zeros({channels.full}), bias};
  for (int c = 0; c < 3; ++c) {  // t = 2·√albedo − 1, which is the normalised feature
    net.full_weights[1].select(0, kEncodedDiffuse + c).select(0, channels.full + c)[1][1] += 1.0;
  }
  net.final_feed = torch::zeros({kEncodedChannels, channels.global});
  return net;
}

NamedTensors EstimatorNetwork::State() {
  NamedTensors list;
  const auto add = [&](const std::string& part, std::vector<Tensor>* tensors, size_t count) {
    tensors->resize(count);
    for (size_t i = 0; i < count; ++i) {
      list.emplace_back(part + "." + std::to_string(i), &(*tensors)[i]);
    }
  };
  add("down.weight", &down_weights, kEstimatorLevels);
  add("down.bias", &down_biases, kEstimatorLevels);
  add("up.weight", &up_weights, kEstimatorLevels);
  add("up.bias", &up_biases, kEstimatorLevels);
  add("global.weight", &global_weights, kEstimatorLevels);
  add("global.bias", &global_biases, kEstimatorLevels);
  add("feed.weight", &feed_weights, kEstimatorLevels);
  add("full.weight", &full_weights, 2);
  add("full.bias", &full_biases, 2);
  list.emplace_back("final.feed", &final_feed);
  return list;
}

Tensor EstimatorNetwork::Forward(const Tensor& features, const Tensor& profile,
                                 torch::Dtype compute) const {
  const Tensor input = AsType(Normalised(features), compute);
  Tensor global = profile * kProfileScale, x = input;
  std::vector<Tensor> skips;
  for (int i = 0; i < kEstimatorLevels; ++i) {
    x = DownConvolve(x, down_weights[i], down_biases[i], compute);
    const Tensor seen = torch::cat({x.to(torch::kFloat32).mean({2, 3}), global}, 1);
    global = at::leaky_relu(torch::addmm(global_biases[i], seen, global_weights[i].t()), kLeak);
    x = at::leaky_relu(x + Spread(global, feed_weights[i]).to(compute), kLeak);
    skips.push_back(x);
  }
  for (int i = kEstimatorLevels - 1; i >= 0; --i) {
    if (i < kEstimatorLevels - 1) x = torch::cat({x, skips[i]}, 1);
    x = at::leaky_relu(UpConvolve(x.contiguous(torch::MemoryFormat::ChannelsLast), up_weights[i],
                                  up_biases[i], compute),
                       kLeak);
  }
  const auto full = [&](const Tensor& y, int k) {
    const Tensor both = torch::cat({y, input}, 1).contiguous(torch::MemoryFormat::ChannelsLast);
    return at::conv2d(both, AsType(full_weights[k], compute), full_biases[k].to(compute), 1, 1);
  };
  x = at::leaky_relu(full(x, 0), kLeak);
  const Tensor out = full(x, 1).to(torch::kFloat32) + Spread(global, final_feed);
  return at::tanh(out.contiguous());
}

EstimatorNetwork Clone(EstimatorNetwork* network) {
  EstimatorNetwork copy;
  copy.channels = network->channels;
  CopyTensors(network->State(), copy.State());
  return copy;
}

}  // namespace glint
