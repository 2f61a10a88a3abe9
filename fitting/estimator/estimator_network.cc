#include "fitting/estimator/estimator_network.h"

#include <cmath>
#include <numeric>
#include <stdexcept>

#include "fitting/encoding/encoding.h"
#include "fitting/estimator/estimator_conditions.h"
#include "fitting/estimator/photograph_features.h"
#include "fitting/layers/layers.h"
#include "fitting/layers/staging.h"

namespace glint {
namespace {

using torch::Tensor;

// Means and spreads that bring the features near the range −1 … 1.
constexpr double kFeatureMean[kFeaturePlanes] = {0.5, 0.5, 0.5, 0, 1, 0, 0, 0, 0, 0.35, 0};
constexpr double kFeatureScale[kFeaturePlanes] = {2, 2, 2, 1, 1, 1.5, 1.5, 1.5, 1.5, 2.5, 0.7};
constexpr int kMaskPlane = 4, kPlanesOfMask = 5;  // planes 0–4 are 0 where the mask is
constexpr double kProfileScale = 0.4;
constexpr double kFirstRoughness = 0.1;  // of the tanh's argument: r about 0.55
constexpr double kFirstSpecular = -0.6;  // F0 about 0.05
constexpr double kFirstLogScale = -2.5;  // mean absolute error .08 of a range of 2
// ln b is kept between an 8-bit rounding of the encoded value and the whole range.
constexpr double kLeastLogScale = -6, kMostLogScale = 0.7;

constexpr int kOutputs = 2 * kEncodedChannels;
constexpr int kPooledInputs = 3 * kFeaturePlanes;  // mean, maximum, minimum over photographs

Tensor Normalised(const Tensor& features) {
  const auto row = [&](const double* values) {
    return Staged({values, kFeaturePlanes}, {1, kFeaturePlanes, 1, 1}, features.options());
  };
  return (features - row(kFeatureMean)) * row(kFeatureScale);
}

// What level i's up-convolution reads: mean and maximum of the level's features over the
// photographs and, for all but the deepest, what came up from below.
int UpInput(const EstimatorChannels& c, int level) {
  return (level == kEstimatorLevels - 1 ? 2 : 3) * c.levels[level];
}

int UpOutput(const EstimatorChannels& c, int level) {
  return level == 0 ? c.full : c.levels[level - 1];
}

int FullInput(const EstimatorChannels& c, int k) {
  return c.full + kPooledInputs + (k == 0 ? 2 * c.full : 0);
}

// What photographs are pooled of: the levels, full resolution, the global track.
std::vector<int> AttendedChannels(const EstimatorChannels& c) {
  std::vector<int> list(c.levels.begin(), c.levels.end());
  list.push_back(c.full);
  list.push_back(c.global);
  return list;
}

Tensor Spread(const Tensor& global, const Tensor& weight) {
  return torch::matmul(global, weight.t()).unsqueeze(2).unsqueeze(3);
}

// `x` and, added to it, a 3×3 convolution of it.
Tensor WithResidual(const Tensor& x, const Tensor& weight, const Tensor& bias,
                    torch::Dtype compute) {
  return x + at::leaky_relu(at::conv2d(x, AsType(weight, compute), bias.to(compute), 1, 1), kLeak);
}

// [B·N, …] → mean and maximum over N, side by side: [B, 2·…].
Tensor Pooled(const Tensor& x, int64_t photographs) {
  if (photographs == 1) return torch::cat({x, x}, 1);
  std::vector<int64_t> shape = x.sizes().vec();
  shape[0] = photographs;
  shape.insert(shape.begin(), x.size(0) / photographs);
  const Tensor y = x.contiguous().view(shape);
  return torch::cat({y.mean(1), y.amax(1)}, 1);
}

// Heads of attention, each of as many channels.
constexpr int64_t kHeads = 4;
int64_t HeadsOf(int64_t channels) { return std::gcd(kHeads, channels); }

// [B·N, C, …] → two averages over N, side by side: [B, 2·C, …]. Each head of an average has weights
// of its own, softmax over N of its scores.
Tensor Attended(const Tensor& x, int64_t photographs, const Tensor& weight) {
  if (photographs == 1) return torch::cat({x, x}, 1);
  const bool picture = x.dim() == 4;
  const Tensor all = picture ? x : x.unsqueeze(2).unsqueeze(3);
  const int64_t b = all.size(0) / photographs, c = all.size(1), h = all.size(2), w = all.size(3);
  const int64_t heads = HeadsOf(c);
  const Tensor scores =
      at::conv2d(all, AsType(weight.view({2 * heads, c, 1, 1}), all.scalar_type()))
          .to(torch::kFloat32)
          .contiguous()
          .view({b, photographs, 2, heads, 1, h, w})
          .softmax(1)
          .to(all.scalar_type());
  const Tensor values = all.contiguous().view({b, photographs, 1, heads, c / heads, h, w});
  const Tensor mean = (scores * values).sum(1).view({b, 2 * c, h, w});
  return picture ? mean : mean.view({b, 2 * c});
}

// Mean, maximum and minimum over the photographs in which the texel is usable; elsewhere those of
// the values as they are. features [B, N, 11, H, W] → normalised [B, 33, H, W].
Tensor PooledInputs(const Tensor& features) {
  const Tensor mask = features.slice(2, kMaskPlane, kMaskPlane + 1);
  const Tensor seen = features.slice(2, 0, kPlanesOfMask);
  const Tensor rest = features.slice(2, kPlanesOfMask);
  const Tensor any = mask.amax(1);
  constexpr double kFar = 1e3;  // beyond all features
  const Tensor mean = (seen * mask).sum(1) / mask.sum(1).clamp_min(1);
  const Tensor most = (seen - kFar * (1 - mask)).amax(1) * any;
  const Tensor least = (seen + kFar * (1 - mask)).amin(1) * any;
  const Tensor all =
      torch::stack({torch::cat({mean, rest.mean(1)}, 1), torch::cat({most, rest.amax(1)}, 1),
                    torch::cat({least, rest.amin(1)}, 1)},
                   1);
  const int64_t b = features.size(0), h = features.size(3), w = features.size(4);
  return Normalised(all.view({b * 3, kFeaturePlanes, h, w})).view({b, kPooledInputs, h, w});
}

}  // namespace

std::string EstimatorKindName(EstimatorKind kind) {
  switch (kind) {
    case EstimatorKind::kPooled:
      return "pooled";
    case EstimatorKind::kAttended:
      return "attended";
    case EstimatorKind::kDescent:
      return "descent";
  }
  return "";
}

EstimatorKind ParseEstimatorKind(const std::string& name) {
  for (const EstimatorKind kind :
       {EstimatorKind::kPooled, EstimatorKind::kAttended, EstimatorKind::kDescent}) {
    if (name == EstimatorKindName(kind)) return kind;
  }
  throw std::invalid_argument("network: found \"" + name + "\"; give pooled, attended or descent");
}

EstimatorNetwork EstimatorNetwork::Random(const EstimatorChannels& channels, std::uint64_t seed,
                                          EstimatorKind kind) {
  torch::Generator generator = torch::make_generator<torch::CPUGeneratorImpl>(seed);
  const auto draw = [&](std::vector<int64_t> shape, double fan_in, double gain) {
    return torch::randn(shape, generator) * (gain * std::sqrt(2.0 / fan_in));
  };
  EstimatorNetwork net;
  net.channels = channels;
  net.kind = kind;
  for (int i = 0; i < kEstimatorLevels; ++i) {
    const int in = i == 0 ? kFeaturePlanes : channels.levels[i - 1], out = channels.levels[i];
    net.down_weights.push_back(draw({out, in, 4, 4}, in * 16.0, 1));
    net.down_biases.push_back(torch::zeros({out}));
    const int seen = out + (i == 0 ? kProfileValues + kEstimatorConditions : channels.global);
    net.global_weights.push_back(draw({channels.global, seen}, seen, 1));
    net.global_biases.push_back(torch::zeros({channels.global}));
    net.feed_weights.push_back(draw({out, channels.global}, channels.global, 0.3));
    const int up_in = UpInput(channels, i), up_out = UpOutput(channels, i);
    net.up_weights.push_back(PhaseKernels(draw({up_out, up_in, 3, 3}, up_in * 9.0, 0.75)));
    net.up_biases.push_back(torch::zeros({4 * up_out}));
    constexpr double kResidualGain = 0.3;
    net.down_residual_weights.push_back(draw({out, out, 3, 3}, out * 9.0, kResidualGain));
    net.down_residual_biases.push_back(torch::zeros({out}));
    if (i >= kResidualUpLevels) continue;
    net.up_residual_weights.push_back(draw({out, out, 3, 3}, out * 9.0, kResidualGain));
    net.up_residual_biases.push_back(torch::zeros({out}));
  }
  net.photograph_weight = draw({channels.full, kFeaturePlanes, 3, 3}, kFeaturePlanes * 9.0, 1);
  net.photograph_bias = torch::zeros({channels.full});
  net.full_weights = {
      draw({channels.full, FullInput(channels, 0), 3, 3}, FullInput(channels, 0) * 9.0, 1),
      draw({kOutputs, FullInput(channels, 1), 3, 3}, FullInput(channels, 1) * 9.0, 0.1)};
  Tensor bias = torch::zeros({kOutputs});
  bias.slice(0, kEncodedSpecular, kEncodedRoughness).fill_(kFirstSpecular);
  bias.slice(0, kEncodedRoughness, kEncodedNormal).fill_(kFirstRoughness);
  bias.slice(0, kEncodedChannels).fill_(kFirstLogScale);
  net.full_biases = {torch::zeros({channels.full}), bias};
  for (int c = 0; c < 3; ++c) {  // t = 2·√albedo − 1, which is the normalised mean feature
    net.full_weights[1].select(0, kEncodedDiffuse + c).select(0, channels.full + c)[1][1] += 1.0;
  }
  net.final_feed = torch::zeros({kOutputs, 2 * channels.global});
  if (kind == EstimatorKind::kAttended) {
    for (const int c : AttendedChannels(channels)) {
      net.attention_weights.push_back(draw({2 * HeadsOf(c), c}, c, 1));
    }
  }
  if (kind == EstimatorKind::kDescent) net.descent = DescentNetwork::Random(seed + 1);
  return net;
}

void EstimatorNetwork::AdoptSinglePhotograph(const std::map<std::string, Tensor>& v1) {
  torch::NoGradGuard no_gradient;
  // A v1 tensor becomes this network's weights of the first inputs (the mean features) for the
  // first outputs (the maps). The weights of new inputs begin at 0.
  for (auto& [name, to] : State()) {
    const auto from = v1.find(name);
    if (from == v1.end()) {
      // Per photograph at full resolution: as drawn. Residual convolutions: nothing yet.
      if (name.find("residual") != std::string::npos) to->zero_();
      continue;
    }
    Tensor outputs = to->slice(0, 0, from->second.size(0));
    if (to->dim() == 1) {
      outputs.copy_(from->second);
    } else {
      to->zero_();
      outputs.slice(1, 0, from->second.size(1)).copy_(from->second);
    }
  }
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
  add("down_residual.weight", &down_residual_weights, kEstimatorLevels);
  add("down_residual.bias", &down_residual_biases, kEstimatorLevels);
  add("up_residual.weight", &up_residual_weights, kResidualUpLevels);
  add("up_residual.bias", &up_residual_biases, kResidualUpLevels);
  add("global.weight", &global_weights, kEstimatorLevels);
  add("global.bias", &global_biases, kEstimatorLevels);
  add("feed.weight", &feed_weights, kEstimatorLevels);
  add("full.weight", &full_weights, 2);
  add("full.bias", &full_biases, 2);
  list.emplace_back("photograph.weight", &photograph_weight);
  list.emplace_back("photograph.bias", &photograph_bias);
  list.emplace_back("final.feed", &final_feed);
  if (kind == EstimatorKind::kAttended) {
    add("attention.weight", &attention_weights, AttendedChannels(channels).size());
  }
  if (kind == EstimatorKind::kDescent) {
    for (const auto& tensor : descent.State()) list.push_back(tensor);
  }
  return list;
}

EstimatorOutput EstimatorNetwork::Forward(const Tensor& features, const Tensor& profiles,
                                          const Tensor& conditions, torch::Dtype compute) const {
  const int64_t photographs = features.size(1);
  const auto pool = [&](const Tensor& x, size_t part) {
    return kind == EstimatorKind::kAttended ? Attended(x, photographs, attention_weights[part])
                                            : Pooled(x, photographs);
  };
  const Tensor input = AsType(Normalised(features.flatten(0, 1)), compute);
  const Tensor known = conditions.unsqueeze(1).expand({-1, photographs, -1}).flatten(0, 1);
  Tensor global = torch::cat({profiles.flatten(0, 1) * kProfileScale, known}, 1), x = input;
  std::vector<Tensor> skips;
  for (int i = 0; i < kEstimatorLevels; ++i) {
    x = DownConvolve(x, down_weights[i], down_biases[i], compute);
    const Tensor seen = torch::cat({x.to(torch::kFloat32).mean({2, 3}), global}, 1);
    global = at::leaky_relu(torch::addmm(global_biases[i], seen, global_weights[i].t()), kLeak);
    x = at::leaky_relu(x + Spread(global, feed_weights[i]).to(compute), kLeak);
    if (residual) x = WithResidual(x, down_residual_weights[i], down_residual_biases[i], compute);
    skips.push_back(pool(x, static_cast<size_t>(i)));
  }
  const auto channels_last = [](const Tensor& t) {
    return t.contiguous(torch::MemoryFormat::ChannelsLast);
  };
  x = skips.back();
  for (int i = kEstimatorLevels - 1; i >= 0; --i) {
    if (i < kEstimatorLevels - 1) x = torch::cat({x, skips[i]}, 1);
    x = at::leaky_relu(UpConvolve(channels_last(x), up_weights[i], up_biases[i], compute), kLeak);
    if (residual && i > 0)
      x = WithResidual(x, up_residual_weights[i - 1], up_residual_biases[i - 1], compute);
  }
  const auto convolve = [&](const Tensor& y, const Tensor& weight, const Tensor& bias) {
    return at::conv2d(channels_last(y), AsType(weight, compute), bias.to(compute), 1, 1);
  };
  const Tensor pooled = AsType(PooledInputs(features), compute);
  const Tensor detail = pool(
      at::leaky_relu(convolve(input, photograph_weight, photograph_bias), kLeak), kEstimatorLevels);
  x = at::leaky_relu(convolve(torch::cat({x, pooled, detail}, 1), full_weights[0], full_biases[0]),
                     kLeak);
  const Tensor out =
      (convolve(torch::cat({x, pooled}, 1), full_weights[1], full_biases[1]).to(torch::kFloat32) +
       Spread(pool(global, kEstimatorLevels + 1), final_feed))
          .contiguous();
  Tensor maps = at::tanh(out.slice(1, 0, kEncodedChannels).contiguous());
  Tensor log_scale = out.slice(1, kEncodedChannels);
  if (kind == EstimatorKind::kDescent) descent.Improve(features, compute, &maps, &log_scale);
  return {maps, log_scale.clamp(kLeastLogScale, kMostLogScale)};
}

EstimatorNetwork Clone(EstimatorNetwork* network) {
  EstimatorNetwork copy;
  copy.channels = network->channels;
  copy.kind = network->kind;
  CopyTensors(network->State(), copy.State());
  return copy;
}

}  // namespace glint
