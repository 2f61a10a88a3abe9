#include "fitting/training/training_photographs.h"

#include <algorithm>
#include <cmath>

#include "fitting/encoding/encoding_torch.h"
#include "fitting/estimator/photograph_features.h"
#include "fitting/render/render_autograd.h"

namespace glint {
namespace {

using torch::Tensor;

constexpr double kPi = 3.14159265358979323846;
constexpr double kMostTilt = kPi / 4;
constexpr double kGamma = 2.2;

// How one photograph was taken, and what is believed of it.
struct Shot {
  View view;                  // the truth
  double believed_power = 1;  // what the light's power is taken for, relative to the truth
  double noise = 0;           // standard deviation of the radiance
  bool ldr = true;
};

Vec3d Direction(double tilt, double azimuth) {
  return {std::sin(tilt) * std::cos(azimuth), std::sin(tilt) * std::sin(azimuth), std::cos(tilt)};
}

Shot DrawShot(Stream* random, LightFalloff falloff, bool plain) {
  Shot shot;
  const bool top = plain || random->Uniform() < 0.5;
  const double tilt = plain ? 0
                      : top ? 0.12 * std::abs(random->Normal())
                            : random->Uniform(0, kMostTilt);
  const Vec3d d = Direction(std::min(tilt, kMostTilt), random->Uniform(0, 2 * kPi));
  const double distance = plain ? kDirHeight : random->Uniform(1.4, 3.6);
  const bool apart = !plain && random->Uniform() < 0.4;
  for (int i = 0; i < 3; ++i) {
    shot.view.camera_in_sample_mm[i] = distance * d[i];
    shot.view.light_in_sample_mm[i] =
        distance * d[i] + (apart ? 0.12 * distance / kDirHeight * random->Normal() : 0.0);
  }
  shot.view.light_in_sample_mm[2] = std::max(0.7, shot.view.light_in_sample_mm[2]);
  // Phones clip: half a stop is usual, a stop and more happens, and what is rough then shows the
  // same white as a mirror's highlight.
  const double exposure = plain ? 1 : std::exp(0.15 + 0.55 * random->Normal());
  const double power =
      kPi * exposure * (falloff == LightFalloff::kInverseSquare ? distance * distance : 1);
  shot.view.light_rgb = {power, power, power};
  if (!plain && random->Uniform() < 0.5) shot.believed_power = std::exp(0.12 * random->Normal());
  if (!plain && random->Uniform() < 0.4) shot.noise = random->Uniform(0, 0.012);
  shot.ldr = plain || random->Uniform() < 0.9;
  return shot;
}

float AsRead(float radiance, const Shot& shot, Stream* random) {
  double value = radiance;
  if (shot.noise > 0) value += shot.noise * random->Normal();
  value = std::max(0.0, value);
  if (!shot.ldr) return static_cast<float>(value);
  const double code = std::round(255 * std::pow(std::min(1.0, value), 1 / kGamma));
  return static_cast<float>(std::pow(code / 255, kGamma));
}

}  // namespace

PhotographBatch PhotographMaps(const Tensor& encoded, Stream* random, bool plain) {
  torch::NoGradGuard no_gradient;
  const int64_t count = encoded.size(0);
  const int height = static_cast<int>(encoded.size(2)), width = static_cast<int>(encoded.size(3));
  const bool falls_off = !plain && random->Uniform() < 0.5;
  const double side = plain ? 2.0 : random->Uniform(1.0, 2.4);
  ViewBatch batch;
  batch.plane = {width, height, side, side, TexelSampling::kPixelCentres};
  batch.convention = {DiffuseWeight::kOne,
                      falls_off ? LightFalloff::kInverseSquare : LightFalloff::kNone,
                      TexelSampling::kPixelCentres};
  batch.views_per_element = 1;
  std::vector<Shot> shots;
  for (int64_t b = 0; b < count; ++b) {
    shots.push_back(DrawShot(random, batch.convention.falloff, plain));
    batch.views.push_back(shots.back().view);
  }
  const Tensor rendered = RenderBatch(DecodeTexelsTorch(encoded), batch).contiguous();
  PhotographBatch result{torch::empty({count, kFeaturePlanes, height, width}),
                         torch::empty({count, kProfileValues})};
  const size_t texels = static_cast<size_t>(width) * height;
  for (int64_t b = 0; b < count; ++b) {
    Shot& shot = shots[static_cast<size_t>(b)];
    Photograph photograph{shot.view, shot.ldr, std::vector<float>(3 * texels),
                          std::vector<float>(texels, 1.0f)};
    for (double& power : photograph.view.light_rgb) power *= shot.believed_power;
    const float* from = rendered.data_ptr<float>() + static_cast<size_t>(b) * 3 * texels;
    for (size_t i = 0; i < 3 * texels; ++i) photograph.rgb[i] = AsRead(from[i], shot, random);
    const PhotographFeatures features = FeaturesOf(photograph, batch.plane, batch.convention);
    std::copy(features.planes.begin(), features.planes.end(), result.features[b].data_ptr<float>());
    std::copy(features.profile.begin(), features.profile.end(),
              result.profiles[b].data_ptr<float>());
  }
  return result;
}

}  // namespace glint
