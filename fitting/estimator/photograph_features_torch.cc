#include "fitting/estimator/photograph_features_torch.h"

#include <numbers>
#include <span>

#include "fitting/estimator/photograph_features.h"
#include "fitting/layers/staging.h"

namespace glint {
namespace {

using torch::Tensor;

// The ring of each texel, as weights [B·N, bins, texels] of 0 and 1; 0 in all where `usable` is.
Tensor RingWeights(const Tensor& angle, const Tensor& usable) {
  const std::span<const double> inner_ends(features::kBinEndDegrees.data(), kProfileBins - 1);
  const Tensor ends =
      Staged(inner_ends, {kProfileBins - 1}, angle.options()) * (std::numbers::pi / 180);
  const Tensor ring = torch::bucketize(angle, ends).flatten(0, 1).flatten(1).unsqueeze(1);
  const Tensor bins = torch::arange(kProfileBins, ring.options()).view({1, kProfileBins, 1});
  return (ring == bins).to(angle.scalar_type()) * usable.flatten(0, 1).flatten(1).unsqueeze(1);
}

// [B, N, 72] from the rings' weights and the texels' albedos and clipping.
Tensor Profiles(const Tensor& rings, const Tensor& albedo, const Tensor& clipped) {
  const int64_t b = albedo.size(0), n = albedo.size(1);
  const Tensor logs = (albedo + features::kOffset).log().flatten(0, 1).flatten(2);
  const Tensor green = logs.slice(1, 1, 2);
  const Tensor values =
      torch::cat({logs, green.square(), clipped.flatten(0, 1).flatten(2)}, 1).transpose(1, 2);
  const Tensor sums = torch::bmm(rings, values);  // [B·N, bins, 5]
  const Tensor count = rings.sum(2, /*keepdim=*/true);
  const Tensor means = sums / count.clamp_min(1);
  const Tensor spread = (means.slice(2, 3, 4) - means.slice(2, 1, 2).square()).clamp_min(0).sqrt();
  return torch::cat({means.slice(2, 0, 3), spread, means.slice(2, 4, 5),
                     (count > 0).to(means.scalar_type())},
                    2)
      .reshape({b, n, kProfileValues});
}

}  // namespace

FeatureTensors FeaturesOfTensors(const PhotographTensors& photographs, const ViewTensors& believed,
                                 const SamplePlane& plane, LightFalloff falloff) {
  const auto options = photographs.radiance.options();
  const ViewDirections d = DirectionsOf(believed, plane);
  const Tensor cosine = d.light.slice(2, 2, 3).clamp_min(features::kLeastCosine);
  const Tensor angle = d.half.slice(2, 2, 3).clamp(-1, 1).acos();
  Tensor irradiance = believed.light_rgb * believed.exposure;
  if (falloff == LightFalloff::kInverseSquare) {
    irradiance = irradiance / d.light_distance_squared;
  }
  const Tensor received = irradiance * cosine;  // [B, N, 3, 1 or H, 1 or W]
  const Tensor radiance = photographs.radiance.clamp_min(0);
  const Tensor& mask = photographs.mask;
  const Tensor clipped = (radiance.amax(2, /*keepdim=*/true) >= features::kClipped).to(options) *
                         photographs.ldr * mask;
  const Tensor albedo =
      (std::numbers::pi * radiance / received.clamp_min(features::kLeastIrradiance))
          .clamp_max(features::kBrightest);
  const Tensor dark = (received.mean(2, /*keepdim=*/true) / std::numbers::pi)
                          .clamp_min(features::kLeastIrradiance)
                          .log()
                          .clamp(-features::kLogIrradianceRange, features::kLogIrradianceRange)
                          .expand_as(mask);
  return {torch::cat({albedo.sqrt() * mask, clipped, mask, d.light.slice(2, 0, 2),
                      d.camera.slice(2, 0, 2), angle, dark},
                     2),
          Profiles(RingWeights(angle, mask), albedo, clipped)};
}

}  // namespace glint
