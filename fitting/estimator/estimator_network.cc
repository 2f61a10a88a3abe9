#include "fitting/estimator/estimator_network.h"

#include <algorithm>
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

// What the global track starts from, of B·N photographs.
Tensor FirstGlobal(const Tensor& profiles, const Tensor& conditions) {
  const Tensor known = conditions.unsqueeze(1).expand({-1, profiles.size(1), -1}).flatten(0, 1);
  return torch::cat({profiles.flatten(0, 1) * kProfileScale, known}, 1);
}

Tensor ChannelsLast(const Tensor& t) { return t.contiguous(torch::MemoryFormat::ChannelsLast); }

// Rows that the last convolutions do at a time, where memory counts, and those about a row that
// they depend on: three 3×3 convolutions.
constexpr int64_t kBandRows = 128, kRowsAbout = 3;

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
  const auto draw = [&](const std::vector<int64_t>& shape, double fan_in, double gain) {
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

Tensor EstimatorNetwork::Pool(const Tensor& x, int64_t photographs, size_t part) const {
  return kind == EstimatorKind::kAttended ? Attended(x, photographs, attention_weights[part])
                                          : Pooled(x, photographs);
}

EstimatorNetwork::Codes EstimatorNetwork::Encode(const Tensor& features, const Tensor& first_global,
                                                 const std::vector<Tensor>* global,
                                                 torch::Dtype compute) const {
  Codes codes;
  Tensor x = AsType(Normalised(features.flatten(0, 1)), compute), track = first_global;
  for (int i = 0; i < kEstimatorLevels; ++i) {
    x = DownConvolve(x, down_weights[i], down_biases[i], compute);
    if (global != nullptr) {
      track = (*global)[static_cast<size_t>(i)];
    } else {
      const Tensor seen = torch::cat({x.to(torch::kFloat32).mean({2, 3}), track}, 1);
      track = at::leaky_relu(torch::addmm(global_biases[i], seen, global_weights[i].t()), kLeak);
    }
    x = at::leaky_relu(x + Spread(track, feed_weights[i]).to(compute), kLeak);
    x = WithResidual(x, down_residual_weights[i], down_residual_biases[i], compute);
    codes.levels.push_back(Pool(x, features.size(1), static_cast<size_t>(i)));
    codes.global.push_back(track);
  }
  return codes;
}

Tensor EstimatorNetwork::Decode(const Codes& codes, torch::Dtype compute) const {
  Tensor x = codes.levels.back();
  for (int i = kEstimatorLevels - 1; i >= 0; --i) {
    if (i < kEstimatorLevels - 1) x = torch::cat({x, codes.levels[static_cast<size_t>(i)]}, 1);
    x = at::leaky_relu(UpConvolve(ChannelsLast(x), up_weights[i], up_biases[i], compute), kLeak);
    if (i > 0) x = WithResidual(x, up_residual_weights[i - 1], up_residual_biases[i - 1], compute);
  }
  return x;
}

Tensor EstimatorNetwork::FullResolution(const Tensor& features, const Tensor& decoded,
                                        torch::Dtype compute) const {
  const auto convolve = [&](const Tensor& y, const Tensor& weight, const Tensor& bias) {
    return at::conv2d(ChannelsLast(y), AsType(weight, compute), bias.to(compute), 1, 1);
  };
  const Tensor input = AsType(Normalised(features.flatten(0, 1)), compute);
  const Tensor pooled = AsType(PooledInputs(features), compute);
  const Tensor detail =
      Pool(at::leaky_relu(convolve(input, photograph_weight, photograph_bias), kLeak),
           features.size(1), kEstimatorLevels);
  const Tensor x = at::leaky_relu(
      convolve(torch::cat({decoded, pooled, detail}, 1), full_weights[0], full_biases[0]), kLeak);
  return convolve(torch::cat({x, pooled}, 1), full_weights[1], full_biases[1]).to(torch::kFloat32);
}

EstimatorOutput EstimatorNetwork::Output(const Tensor& features, const Tensor& full,
                                         const Tensor& global, torch::Dtype compute) const {
  const Tensor track = Pool(global, features.size(1), kEstimatorLevels + 1);
  const Tensor out = (full + Spread(track, final_feed)).contiguous();
  Tensor maps = at::tanh(out.slice(1, 0, kEncodedChannels).contiguous());
  Tensor log_scale = out.slice(1, kEncodedChannels);
  if (kind == EstimatorKind::kDescent) descent.Improve(features, compute, &maps, &log_scale);
  return {maps, log_scale.clamp(kLeastLogScale, kMostLogScale)};
}

std::vector<Tensor> EstimatorNetwork::Global(const Tensor& features, const Tensor& profiles,
                                             const Tensor& conditions, torch::Dtype compute) const {
  return Encode(features, FirstGlobal(profiles, conditions), nullptr, compute).global;
}

EstimatorOutput EstimatorNetwork::Forward(const Tensor& features, const Tensor& profiles,
                                          const Tensor& conditions, torch::Dtype compute) const {
  const Codes codes = Encode(features, FirstGlobal(profiles, conditions), nullptr, compute);
  const Tensor full = FullResolution(features, Decode(codes, compute), compute);
  return Output(features, full, codes.global.back(), compute);
}

EstimatorOutput EstimatorNetwork::ForwardWithGlobal(const Tensor& features,
                                                    const std::vector<Tensor>& global,
                                                    torch::Dtype compute) const {
  const Tensor decoded = Decode(Encode(features, {}, &global, compute), compute);
  const int64_t height = features.size(3);
  std::vector<Tensor> bands;
  for (int64_t begin = 0; begin < height; begin += kBandRows) {
    const int64_t end = std::min(begin + kBandRows, height);
    const int64_t first = std::max<int64_t>(0, begin - kRowsAbout);
    const int64_t last = std::min(height, end + kRowsAbout);
    const Tensor band =
        FullResolution(features.slice(3, first, last), decoded.slice(2, first, last), compute);
    bands.push_back(band.slice(2, begin - first, end - first).contiguous());
  }
  return Output(features, torch::cat(bands, 2), global.back(), compute);
}

EstimatorNetwork Clone(EstimatorNetwork* network) {
  EstimatorNetwork copy;
  copy.channels = network->channels;
  copy.kind = network->kind;
  CopyTensors(network->State(), copy.State());
  return copy;
}

}  // namespace glint
