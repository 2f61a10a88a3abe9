#include "fitting/estimator/estimator_descent.h"

#include <cmath>
#include <numbers>
#include <string>

#include "base/reflectance/brdf_constants.h"
#include "base/reflectance/svbrdf_maps.h"
#include "fitting/encoding/encoding.h"
#include "fitting/encoding/encoding_torch.h"
#include "fitting/estimator/photograph_features.h"
#include "fitting/layers/layers.h"

namespace glint {
namespace {

using torch::Tensor;

constexpr int kDescentWidth = 32;
constexpr int kLookedAt = 3 * kEncodedChannels + 6;  // maps, gradient, errors, two residuals
constexpr int kChanges = 2 * kEncodedChannels;
constexpr int kDescentLayers = 3;
constexpr int kDilation[kDescentLayers] = {1, 2, 1};
constexpr double kLeastRoot = 1e-3;     // under a root, against its slope at 0
constexpr double kResidualScale = 0.1;  // from where on a residual counts linearly
constexpr double kGradientScale = 5;    // brings gradients near the range −1 … 1
constexpr double kMostEncoded = 0.999;  // against infinite arguments of tanh

Tensor Dot(const Tensor& a, const Tensor& b) { return (a * b).sum(2, /*keepdim=*/true); }

// Unit vectors [B, N, 3, H, W] from their x and y, planes `first` and the next.
Tensor DirectionFrom(const Tensor& features, int64_t first) {
  const Tensor xy = features.slice(2, first, first + 2);
  const Tensor z = (1 - xy.square().sum(2, /*keepdim=*/true)).clamp_min(1e-4).sqrt();
  return torch::cat({xy, z}, 2);
}

// The features' first planes as the maps predict them: √(π·f·NoL / l_z), the model of brdf.h.
Tensor PredictedRoots(const Tensor& encoded, const Tensor& features) {
  const Tensor maps = DecodeTexelsReference(encoded).unsqueeze(1);
  const Tensor normal = maps.slice(2, kNormalX, kDiffuseR);
  const Tensor diffuse = maps.slice(2, kDiffuseR, kSpecularR);
  const Tensor specular = maps.slice(2, kSpecularR, kRoughness);
  const Tensor alpha = maps.slice(2, kRoughness, kSvbrdfPlanes).square();
  const Tensor light = DirectionFrom(features, 5), camera = DirectionFrom(features, 7);
  const Tensor sum = light + camera;
  const Tensor half = sum / sum.square().sum(2, /*keepdim=*/true).sqrt().clamp_min(1e-6);
  const Tensor n_dot_l = Dot(normal, light).clamp_min(kDotClamp);
  const Tensor n_dot_v = Dot(normal, camera).clamp_min(kDotClamp);
  const Tensor v_dot_h = Dot(camera, half).clamp_min(kDotClamp);
  const Tensor n_dot_h = Dot(normal, half).clamp_min(kDotClamp);
  const Tensor power = torch::exp2(v_dot_h * (kFresnelSquare * v_dot_h + kFresnelLinear));
  const Tensor fresnel = specular + (1 - specular) * power;
  const Tensor t = (1 - n_dot_h.square()).clamp_min(0) + (n_dot_h * alpha).square();
  const Tensor ratio = alpha / t.clamp_min(kDenominatorClamp);
  const Tensor k = (alpha * 0.5).clamp_min(kDenominatorClamp);
  const Tensor masking = (n_dot_l * (1 - k) + k) * (n_dot_v * (1 - k) + k);
  const Tensor lobe = ratio.square() * 0.25 / masking * fresnel;  // times π
  const Tensor flat = light.slice(2, 2, 3).clamp_min(features::kLeastCosine);
  return ((diffuse + lobe) * n_dot_l / flat).clamp(kLeastRoot, features::kBrightest).sqrt();
}

}  // namespace

Unexplained UnexplainedBy(const Tensor& maps, const Tensor& features) {
  const torch::AutoGradMode with_gradient(true);
  const Tensor leaf = maps.detach().clone().set_requires_grad(true);
  const Tensor seen = features.detach();
  const Tensor mask = seen.slice(2, 4, 5), clipped = seen.slice(2, 3, 4);
  const Tensor residual = (seen.slice(2, 0, 3) - PredictedRoots(leaf, seen)) * mask;
  const Tensor counted = torch::where(clipped > 0.5, residual.clamp_min(0), residual);
  const Tensor count = mask.sum(1).clamp_min(1);
  const Tensor loss =
      ((counted.square() + kResidualScale * kResidualScale).sqrt().sum(1) / count).sum();
  const Tensor gradient = torch::autograd::grad({loss}, {leaf})[0];
  const Tensor known = counted.detach();
  return {gradient.detach(), known.sum(1) / count, known.abs().sum(1) / count};
}

DescentNetwork DescentNetwork::Random(std::uint64_t seed) {
  torch::Generator generator = torch::make_generator<torch::CPUGeneratorImpl>(seed);
  DescentNetwork net;
  for (int i = 0; i < kDescentLayers; ++i) {
    const int in = i == 0 ? kLookedAt : kDescentWidth,
              out = i == kDescentLayers - 1 ? kChanges : kDescentWidth;
    const double gain = i == kDescentLayers - 1 ? 0.0 : 1.0;  // the first changes are none
    net.weights.push_back(torch::randn({out, in, 3, 3}, generator) *
                          (gain * std::sqrt(2.0 / (in * 9.0))));
    net.biases.push_back(torch::zeros({out}));
  }
  return net;
}

NamedTensors DescentNetwork::State() {
  NamedTensors list;
  weights.resize(kDescentLayers);
  biases.resize(kDescentLayers);
  for (size_t i = 0; i < kDescentLayers; ++i) {
    list.emplace_back("descent.weight." + std::to_string(i), &weights[i]);
    list.emplace_back("descent.bias." + std::to_string(i), &biases[i]);
  }
  return list;
}

void DescentNetwork::Improve(const Tensor& features, torch::Dtype compute, Tensor* maps,
                             Tensor* log_scale) const {
  for (int step = 0; step < kDescentSteps; ++step) {
    const Unexplained left = UnexplainedBy(*maps, features);
    Tensor x = AsType(torch::cat({*maps, (kGradientScale * left.gradient).clamp(-3, 3), *log_scale,
                                  left.residual, left.size},
                                 1),
                      compute);
    for (size_t i = 0; i < kDescentLayers; ++i) {
      x = at::conv2d(x, AsType(weights[i], compute), biases[i].to(compute), 1, kDilation[i],
                     kDilation[i]);
      if (i + 1 < kDescentLayers) x = at::leaky_relu(x, kLeak);
    }
    const Tensor change = x.to(torch::kFloat32).contiguous();
    *maps =
        (maps->clamp(-kMostEncoded, kMostEncoded).atanh() + change.slice(1, 0, kEncodedChannels))
            .tanh();
    *log_scale = *log_scale + change.slice(1, kEncodedChannels);
  }
}

}  // namespace glint
