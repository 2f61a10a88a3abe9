#include "training/training_photographs.h"

#include <cmath>
#include <numbers>
#include <vector>

#include "fitting/encoding/encoding_torch.h"
#include "fitting/estimator/photograph_features_torch.h"
#include "fitting/render/view_tensors.h"
#include "training/camera_pictures.h"
#include "training/capture_draw.h"
#include "training/capture_numbers.h"
#include "training/guessed_power.h"
#include "training/training_materials.h"

namespace glint {
namespace {

using torch::Tensor;

// A batch's captures: as they are, as the estimator is told, and their numbers on the device.
struct Captures {
  std::vector<DrawnCapture> drawn;
  ViewBatch truth, believed;
  CaptureNumbers of;
  ViewDirections directions;  // of the truth

  Captures(std::vector<DrawnCapture> captures, const ViewBatch& seen,
           const torch::TensorOptions& options)
      : drawn(std::move(captures)), truth(seen), believed(seen), of(drawn, options) {
    for (const DrawnCapture& capture : drawn) {
      for (const Shot& shot : capture.shots) {
        truth.views.push_back(shot.view);
        believed.views.push_back(shot.believed);
      }
    }
    directions = DirectionsOf(TensorsOf(truth, options), truth.plane);
  }
};

// Texel positions in [−1, 1]²: x rising with columns, y falling with rows.
std::pair<Tensor, Tensor> Positions(const SamplePlane& plane, const torch::TensorOptions& options) {
  const Tensor x = (torch::arange(plane.width, options) + 0.5) * (2.0 / plane.width) - 1;
  const Tensor y = 1 - (torch::arange(plane.height, options) + 0.5) * (2.0 / plane.height);
  return {x.view({1, 1, 1, 1, -1}), y.view({1, 1, 1, -1, 1})};
}

// What the camera's radiance is multiplied with and the renderer does not know, [B, N, 1, H, W].
Tensor Gains(const Captures& captures, const torch::TensorOptions& options) {
  const auto [x, y] = Positions(captures.truth.plane, options);
  const CaptureNumbers& of = captures.of;
  const Tensor angle = captures.directions.half.slice(2, 2, 3).clamp(-1, 1).acos();
  const Tensor wave =
      (2 * std::numbers::pi * angle / of(&Disturbance::gain_period) + of(&Disturbance::gain_phase))
          .sin();
  return (of(&Shot::gradient_x) * x + of(&Shot::gradient_y) * y +
          of(&Shot::vignetting) * (x.square() + y.square() - 0.67) + of(&Disturbance::gain) * wave)
      .exp();
}

// The part of a batch that a subset's captures see.
ViewBatch ViewsOf(const ViewBatch& all, const CaptureSubset& subset) {
  ViewBatch part = all;
  part.views.clear();
  const auto shots = static_cast<size_t>(all.views_per_element);
  for (const size_t b : subset.numbers) {
    const auto from = all.views.begin() + static_cast<std::ptrdiff_t>(b * shots);
    part.views.insert(part.views.end(), from, from + static_cast<std::ptrdiff_t>(shots));
  }
  return part;
}

// The renderings of all shots, [B, N, 3, S, S]: of the maps, and where a capture has a second lobe,
// mixed with those of the maps of another roughness.
Tensor Render(const Tensor& encoded, const Captures& captures) {
  const Tensor maps = DecodeTexelsTorch(encoded);
  const Tensor one = RenderBatch(maps, captures.truth);
  const CaptureSubset two(captures.drawn, encoded.options(), [](const DrawnCapture& capture) {
    return capture.disturbance.second_lobe > 0;
  });
  if (two.empty()) return one;
  const auto of = [&](double Disturbance::*field) {
    return two.Of(captures.of(field).slice(1, 0, 1));
  };
  const Tensor share = of(&Disturbance::second_lobe).clamp_max(0.7);
  Tensor other = two.Of(maps);
  other.select(1, kRoughness)
      .mul_(of(&Disturbance::second_lobe_width).flatten(1).unsqueeze(2))
      .clamp_(0.05, 1);
  const Tensor second = RenderBatch(other, ViewsOf(captures.truth, two));
  return two.Replaced(one, two.Of(one) * (1 - share) + second * share);
}

// Relief of the captures that have some, 0 elsewhere: [B, 1, S, S] in texels.
struct Relief {
  CaptureSubset captures;
  Tensor heights;
};

Relief ReliefOf(const Tensor& encoded, const Captures& captures) {
  CaptureSubset subset(captures.drawn, encoded.options(),
                       [](const DrawnCapture& capture) { return capture.disturbance.relief > 0; });
  Tensor heights =
      torch::zeros({encoded.size(0), 1, encoded.size(2), encoded.size(3)}, encoded.options());
  if (!subset.empty()) heights = subset.Replaced(heights, HeightsOf(subset.Of(encoded)));
  return {subset, heights};
}

Tensor WithCastShadows(const Tensor& pictures, const Relief& relief, const Captures& captures) {
  const CaptureSubset& subset = relief.captures;
  if (subset.empty()) return pictures;
  const Tensor lit = LitShare(subset.Of(relief.heights), subset.Of(captures.directions.light));
  const Tensor shadow = subset.Of(captures.of(&Disturbance::shadow));
  return subset.Replaced(pictures, subset.Of(pictures) * (1 - shadow * (1 - lit)));
}

// Pictures of a sample that lies in another plane than assumed, has relief, and is not where its
// registration says. A texel shows what the camera's ray meets before or behind the assumed plane:
// height times the tangent of the ray aside. Maps lie where a capture's photographs show them in
// the mean: where a sample is exactly, nobody knows.
Tensor Misplaced(const Tensor& pictures, const Relief& relief, const Captures& captures) {
  const SamplePlane& plane = captures.truth.plane;
  const CaptureNumbers& of = captures.of;
  const double texels_per_mm = plane.width / plane.width_mm;
  const auto [x, y] = Positions(plane, pictures.options());
  const Tensor tilt_mm =
      (of(&Disturbance::plane_slope_x) * x + of(&Disturbance::plane_slope_y) * y) *
      (plane.width_mm / 2);
  const Tensor height_mm = of(&Disturbance::plane_height) * plane.width_mm + tilt_mm;
  const Tensor height = height_mm * texels_per_mm + relief.heights.unsqueeze(1);
  const Tensor& camera = captures.directions.camera;
  const Tensor up = camera.slice(2, 2, 3).clamp_min(0.1);
  const auto from_mean = [](const Tensor& t) { return t - t.mean(1, /*keepdim=*/true); };
  return Displaced(pictures, from_mean(height * camera.slice(2, 0, 1) / up + of(&Shot::shift_x)),
                   from_mean(-height * camera.slice(2, 1, 2) / up + of(&Shot::shift_y)));
}

// Linear radiance read back from the photographs that cameras wrote; not of those that do not clip.
Tensor Written(const Tensor& pictures, const Captures& captures) {
  const CaptureNumbers& of = captures.of;
  const Tensor gamma = kPhotographGamma * (1 + of(&Disturbance::gamma));
  Tensor encoded = EncodedIn8Bits(Crushed(pictures, of(&Disturbance::toe)), gamma);
  const CaptureSubset jpeg(captures.drawn, pictures.options(), [](const DrawnCapture& capture) {
    return capture.ldr > 0 && capture.disturbance.jpeg_quality > 0;
  });
  if (!jpeg.empty()) {
    const Tensor quality = jpeg.Of(of(&Disturbance::jpeg_quality).slice(1, 0, 1)).flatten();
    encoded = jpeg.Replaced(encoded, AfterJpeg(jpeg.Of(encoded), quality));
  }
  return torch::where(of(&DrawnCapture::ldr) > 0, encoded.pow(kPhotographGamma),
                      pictures.clamp_min(0));
}

// The rendered radiance [B, N, 3, H, W] as the cameras wrote it. Texels that clip stay usable: the
// estimator is shown no holes there (photograph_features.h).
PhotographTensors Photographed(const Tensor& radiance, const Tensor& encoded,
                               const Captures& captures) {
  const auto options = radiance.options();
  const CaptureNumbers& of = captures.of;
  const Relief relief = ReliefOf(encoded, captures);
  Tensor pictures = radiance * Gains(captures, options);
  pictures = Misplaced(WithCastShadows(pictures, relief, captures), relief, captures);
  pictures = Blurred(pictures, of(&Disturbance::blur)) +
             of(&Disturbance::noise) * torch::randn(radiance.sizes(), options);
  const auto [x, y] = Positions(captures.truth.plane, options);
  const Tensor mask =
      (of(&Shot::frame_x) * x + of(&Shot::frame_y) * y <= of(&Shot::frame_end)).to(options);
  return {Written(pictures, captures) * mask, mask, of(&DrawnCapture::ldr)};
}

// The views that the estimator is told, with the light's power guessed where it is.
ViewTensors BelievedViews(const PhotographTensors& seen, const Captures& captures) {
  const auto options = seen.radiance.options();
  const ViewBatch& batch = captures.believed;
  ViewTensors views = TensorsOf(batch, options);
  const CaptureSubset guessed(captures.drawn, options, [](const DrawnCapture& capture) {
    return capture.power_guessed > 0;
  });
  if (guessed.empty()) return views;
  const PhotographTensors theirs{guessed.Of(seen.radiance), guessed.Of(seen.mask),
                                 guessed.Of(seen.ldr)};
  const ViewTensors told = TensorsOf(ViewsOf(batch, guessed), options);
  const Tensor power = GuessedPower(theirs, told, batch.plane, batch.convention.falloff);
  views.light_rgb = guessed.Replaced(views.light_rgb, power.expand_as(told.light_rgb));
  return views;
}

// Metals are said to be rare of many captures, of few with metal: [B, 2].
Tensor Conditions(const Tensor& encoded, const CaptureNumbers& of) {
  const double metal_code = 2 * std::sqrt(kLeastMetalF0) - 1;
  const Tensor metal = (encoded.slice(1, kEncodedSpecular, kEncodedRoughness).amax(1) > metal_code)
                           .to(encoded.options())
                           .mean({1, 2}) > kLeastMetalShare;
  const auto row = [&](double DrawnCapture::*flag) { return of(flag).slice(1, 0, 1).flatten(); };
  return torch::stack(
      {torch::where(metal, row(&DrawnCapture::rare_if_metal), row(&DrawnCapture::rare_if_not)),
       row(&DrawnCapture::calibrated)},
      1);
}

}  // namespace

CaptureBatch PhotographMaps(const Tensor& encoded, int photographs, CaptureQuality quality,
                            Stream* random) {
  torch::NoGradGuard no_gradient;
  const int height = static_cast<int>(encoded.size(2)), width = static_cast<int>(encoded.size(3));
  const bool clean = quality == CaptureQuality::kClean;
  const CaptureKind kind = clean ? CaptureKind::kDir : DrawCaptureKind(random);
  const double side = clean ? 2.0 : random->Uniform(1.0, 2.4);
  ViewBatch batch;
  batch.plane = {width, height, side, side, TexelSampling::kPixelCentres};
  batch.convention = {DiffuseWeight::kOne, FalloffOf(kind), TexelSampling::kPixelCentres};
  batch.views_per_element = photographs;
  std::vector<DrawnCapture> drawn;
  for (int64_t b = 0; b < encoded.size(0); ++b) {
    drawn.push_back(clean ? CleanCapture(photographs, random)
                          : DrawCapture(kind, photographs, random));
  }
  const Captures captures(std::move(drawn), batch, encoded.options());
  torch::manual_seed(static_cast<std::uint64_t>(random->Bits() >> 1));  // of the noise
  const PhotographTensors seen = Photographed(Render(encoded, captures), encoded, captures);
  const FeatureTensors features =
      FeaturesOfTensors(seen, BelievedViews(seen, captures), batch.plane, batch.convention.falloff);
  return {features.planes, features.profiles, Conditions(encoded, captures.of)};
}

}  // namespace glint
