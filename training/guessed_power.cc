#include "training/guessed_power.h"

#include <limits>
#include <numbers>

#include "fitting/estimator/photograph_features.h"

namespace glint {
namespace {

using torch::Tensor;

// light_guess.cc's.
constexpr int64_t kGrid = 64;
constexpr double kMedianAlbedo = 0.3, kBrightAlbedo = 0.95, kBrightPercent = 95;
constexpr double kNone = std::numeric_limits<double>::infinity();

// At most kGrid of n positions, evenly spread.
Tensor Spread(int64_t n, const torch::TensorOptions& options) {
  const int64_t count = std::min(kGrid, n);
  const Tensor i = torch::arange(count, options.dtype(torch::kInt64));
  return ((2 * i + 1) * n).floor_divide(2 * count);
}

Tensor OnGrid(const Tensor& pictures) {
  return pictures.index_select(3, Spread(pictures.size(3), pictures.options()))
      .index_select(4, Spread(pictures.size(4), pictures.options()));
}

// The element at place ⌊of(count)⌋ of each row's `count` finite values [B, P], which come first.
Tensor At(const Tensor& sorted, const Tensor& place) {
  return sorted.gather(1, place.clamp(0, sorted.size(1) - 1));
}

}  // namespace

Tensor GuessedPower(const PhotographTensors& photographs, const ViewTensors& views,
                    const SamplePlane& plane, LightFalloff falloff) {
  const ViewDirections d = DirectionsOf(views, plane);
  Tensor unit = d.light.slice(2, 2, 3);  // irradiance of a light of power 1
  if (falloff == LightFalloff::kInverseSquare) unit = unit / d.light_distance_squared;
  const Tensor clipped =
      (photographs.radiance.amax(2, /*keepdim=*/true) >= features::kClipped).to(unit.dtype()) *
      photographs.ldr;
  const Tensor usable = OnGrid((photographs.mask * (1 - clipped)).expand_as(unit)) > 0.5;
  const Tensor q =
      torch::where(usable,
                   OnGrid(std::numbers::pi * photographs.radiance.mean(2, /*keepdim=*/true) /
                          (unit * views.exposure)),
                   torch::full({}, kNone, unit.options()));  // [B, N, 1, h, w]
  const Tensor by_view = q.flatten(2).transpose(1, 2);       // [B, P, N]
  const Tensor views_used = usable.flatten(2).sum(1).unsqueeze(2);
  const Tensor middle = (views_used - 1).clamp_min(0).floor_divide(2);
  const Tensor typical =
      std::get<0>(std::get<0>(by_view.sort(2)).gather(2, middle).squeeze(2).sort(1));
  const Tensor points = (views_used > 0).sum({1}).view({-1, 1});
  const Tensor median = At(typical, points.floor_divide(2));
  const Tensor bright =
      At(typical, (points * static_cast<int64_t>(kBrightPercent)).floor_divide(100));
  const Tensor power = torch::maximum(median / kMedianAlbedo, bright / kBrightAlbedo);
  const Tensor own = views.light_rgb.mean({1, 2}).view({-1, 1});
  return torch::where((points > 0) & (power > 0), power, own).view({-1, 1, 1, 1, 1});
}

}  // namespace glint
