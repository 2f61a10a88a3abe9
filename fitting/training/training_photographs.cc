#include "fitting/training/training_photographs.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include "fitting/encoding/encoding_torch.h"
#include "fitting/estimator/photograph_features_torch.h"
#include "fitting/render/view_tensors.h"

namespace glint {
namespace {

using torch::Tensor;

constexpr double kMostTilt = std::numbers::pi / 4;
constexpr double kGamma = 2.2;

enum class CaptureKind {
  kPhone,  // a flash beside the lens, 3 to 5 half-widths away, tilts mostly below 20°
  kDir,    // DIR 2019: light at the camera, (x, y) in ±1.2 at one height, no fall-off
  kFree    // camera anywhere up to 45°, 1.4 to 3.6 half-widths away
};

// What a capture's views and pictures are wrong by. Sizes are what calibrated phone captures show
// (docs/training.md); `size` scales them all, so that a fifth of the captures is nearly clean.
struct Disturbance {
  double exposure = 0;      // of ln exposure, by photograph
  double power = 0;         // of ln power, of all photographs
  double light = 0;         // of the light's position, relative to its distance
  double offset = 0;        // of the place that all lights share, likewise
  double ambient = 0;       // of the flash, irradiance
  double vignetting = 0;    // of ln radiance at the crop's corners
  double registration = 0;  // texels
  double blur = 0;          // weight of each of a texel's neighbours
  double noise = 0;         // of the radiance
  double gamma = 0;         // of the photographs' tone curve, relative
  // The model's own: a second, wider lobe with so much of the light, and a gain that depends on the
  // half vector's angle alone, as lobes of other shapes have.
  double second_lobe = 0, second_lobe_width = 2;
  double gain = 0, gain_period = 0.5, gain_phase = 0;
};

struct Shot {
  View view;      // the truth
  View believed;  // what the estimator is told
  double shift_x = 0, shift_y = 0;
  double gradient_x = 0, gradient_y = 0, vignetting = 0;
  // Where the frame ends: usable where a·x + b·y < c.
  std::array<double, 3> frame{0, 0, 1};
};

struct Drawn {
  Disturbance disturbance;
  std::vector<Shot> shots;
  bool ldr = true;
  bool calibrated = true;
  // Whether metals are said to be rare, if there are any and if not.
  bool rare_if_metal = false, rare_if_not = false;
};

Vec3d Direction(double tilt, double azimuth) {
  return {std::sin(tilt) * std::cos(azimuth), std::sin(tilt) * std::sin(azimuth), std::cos(tilt)};
}

// Of a capture whose light was calibrated a fifth are nearly clean; of others the light's power,
// and the place that all its lights share, are about right only.
Disturbance DrawDisturbance(bool calibrated, Stream* random) {
  Disturbance d;
  const bool clean = calibrated && random->Uniform() < 0.4;
  const double size = clean ? 0.05 : random->Uniform(0.3, calibrated ? 1.0 : 1.5);
  d.exposure = (calibrated ? 0.04 : 0.08) * size;
  d.power = (calibrated ? 0.02 * size : 0.3) * random->Normal();
  d.light = (calibrated ? 0.02 : 0.03) * size;
  d.offset = calibrated ? 0.0 : 0.05;
  d.ambient = 0.03 * size * random->Uniform();
  d.vignetting = (calibrated ? 0.04 : 0.1) * size;
  d.registration = 0.5 * size;
  d.blur = random->Uniform() < 0.5 ? 0.12 * size * random->Uniform() : 0.0;
  d.noise = random->Uniform() < 0.5 ? 0.008 * size * random->Uniform() : 0.0;
  d.gamma = 0.04 * size * random->Normal();
  if (random->Uniform() < 0.35) d.second_lobe = 0.5 * size * random->Uniform();
  d.second_lobe_width = random->Uniform(1.5, 3);
  d.gain = 0.12 * size * random->Normal();
  d.gain_period = random->Uniform(0.3, 1.2);
  d.gain_phase = random->Uniform(0, 2 * std::numbers::pi);
  return d;
}

CaptureKind DrawKind(Stream* random) {
  const double u = random->Uniform();
  return u < 0.5 ? CaptureKind::kPhone : u < 0.8 ? CaptureKind::kDir : CaptureKind::kFree;
}

// Where the camera is; the first photograph of a capture is from near the top mostly.
Vec3d DrawCamera(CaptureKind kind, bool first, double distance, Stream* random) {
  const double azimuth = random->Uniform(0, 2 * std::numbers::pi);
  double tilt = 0;
  switch (kind) {
    case CaptureKind::kDir: {
      const double x = first ? 0 : random->Uniform(-kDirJitter, kDirJitter);
      const double y = first ? 0 : random->Uniform(-kDirJitter, kDirJitter);
      return {x, y, kDirHeight};
    }
    case CaptureKind::kPhone:
      tilt = first                      ? 0.10 * std::abs(random->Normal())
             : random->Uniform() < 0.75 ? random->Uniform(0, 0.35)
                                        : random->Uniform(0, kMostTilt);
      break;
    case CaptureKind::kFree:
      tilt = random->Uniform() < 0.4 ? 0.12 * std::abs(random->Normal())
                                     : random->Uniform(0, kMostTilt);
      break;
  }
  Vec3d camera = Direction(std::min(tilt, kMostTilt), azimuth);
  for (double& x : camera) x *= distance;
  return camera;
}

LightFalloff FalloffOf(CaptureKind kind) {
  return kind == CaptureKind::kDir ? LightFalloff::kNone : LightFalloff::kInverseSquare;
}

Drawn DrawCapture(CaptureKind kind, int photographs, Stream* random) {
  constexpr double kRareIfMetal = 0.06, kRareIfNot = 0.5, kCalibrated = 0.5;
  Drawn drawn;
  drawn.calibrated = random->Uniform() < kCalibrated;
  drawn.rare_if_metal = random->Uniform() < kRareIfMetal;
  drawn.rare_if_not = random->Uniform() < kRareIfNot;
  drawn.disturbance = DrawDisturbance(drawn.calibrated, random);
  drawn.ldr = random->Uniform() < 0.93;
  const Disturbance& d = drawn.disturbance;
  const bool phone = kind == CaptureKind::kPhone;
  const double usual = phone ? random->Uniform(2.6, 5.2) : random->Uniform(1.4, 3.6);
  const double beside = kind == CaptureKind::kDir ? 0.0 : usual * random->Uniform(0, 0.12);
  const double flash_azimuth = random->Uniform(0, 2 * std::numbers::pi);
  // A part of a larger sample is seen from elsewhere than above its middle.
  const bool part = random->Uniform() < 0.5;
  const double part_x = part ? random->Uniform(-0.6, 0.6) : 0;
  const double part_y = part ? random->Uniform(-0.6, 0.6) : 0;
  // Phones clip: half a stop is usual, a stop and more happens, and what is rough then shows the
  // same white as a mirror's highlight.
  const double exposure = std::exp(0.15 + 0.5 * random->Normal());
  const bool frames_end = random->Uniform() < 0.2;
  const double offset_x = d.offset * usual * random->Normal();
  const double offset_y = d.offset * usual * random->Normal();
  for (int i = 0; i < photographs; ++i) {
    Shot shot;
    const double distance = usual * std::exp(0.08 * random->Normal());
    Vec3d camera = DrawCamera(kind, i == 0, distance, random);
    camera[0] += part_x;
    camera[1] += part_y;
    View& view = shot.believed;
    view.camera_in_sample_mm = camera;
    view.light_in_sample_mm = camera;
    view.light_in_sample_mm[0] += beside * std::cos(flash_azimuth);
    view.light_in_sample_mm[1] += beside * std::sin(flash_azimuth);
    const double power = std::numbers::pi * exposure *
                         (FalloffOf(kind) == LightFalloff::kInverseSquare ? usual * usual : 1.0);
    view.light_rgb = {power, power, power};
    shot.view = view;
    for (double& x : shot.view.light_in_sample_mm) x += d.light * distance * random->Normal();
    shot.view.light_in_sample_mm[0] += offset_x;
    shot.view.light_in_sample_mm[1] += offset_y;
    shot.view.light_in_sample_mm[2] = std::max(0.7, shot.view.light_in_sample_mm[2]);
    shot.view.exposure = std::exp(d.exposure * random->Normal());
    const double ambient = d.ambient * std::numbers::pi * exposure;
    shot.view.ambient_rgb = {ambient, ambient, ambient};
    for (double& p : shot.believed.light_rgb) p *= std::exp(d.power);
    shot.shift_x = d.registration * random->Normal();
    shot.shift_y = d.registration * random->Normal();
    shot.gradient_x = 0.5 * d.vignetting * random->Normal();
    shot.gradient_y = 0.5 * d.vignetting * random->Normal();
    shot.vignetting = d.vignetting * random->Normal();
    if (frames_end && random->Uniform() < 0.5) {
      const double azimuth = random->Uniform(0, 2 * std::numbers::pi);
      shot.frame = {std::cos(azimuth), std::sin(azimuth), random->Uniform(0, 0.9)};
    }
    drawn.shots.push_back(shot);
  }
  return drawn;
}

Drawn CleanCapture(int photographs, Stream* random) {
  Drawn drawn;
  for (int i = 0; i < photographs; ++i) {
    const double x = i == 0 ? 0 : random->Uniform(-kDirJitter, kDirJitter);
    const double y = i == 0 ? 0 : random->Uniform(-kDirJitter, kDirJitter);
    Shot shot;
    shot.view = shot.believed = DirView(x, y);
    drawn.shots.push_back(shot);
  }
  return drawn;
}

// One number of every shot, [B, N, 1, 1, 1], on the device that `options` name.
template <class Of>
Tensor OfShots(const std::vector<Drawn>& captures, const torch::TensorOptions& options,
               const Of& number) {
  std::vector<float> values;
  for (const Drawn& drawn : captures) {
    for (const Shot& shot : drawn.shots) {
      values.push_back(static_cast<float>(number(shot, drawn.disturbance)));
    }
  }
  const auto count = static_cast<int64_t>(captures.size());
  return torch::tensor(values).view({count, -1, 1, 1, 1}).to(options);
}

// A field of a capture's disturbance or of a shot, for all shots.
Tensor OfShots(const std::vector<Drawn>& captures, const torch::TensorOptions& options,
               double Disturbance::*field) {
  return OfShots(captures, options, [&](const Shot&, const Disturbance& d) { return d.*field; });
}

Tensor OfShots(const std::vector<Drawn>& captures, const torch::TensorOptions& options,
               double Shot::*field) {
  return OfShots(captures, options,
                 [&](const Shot& shot, const Disturbance&) { return shot.*field; });
}

// Texel positions in [−1, 1]²: x rising with columns, y falling with rows.
std::pair<Tensor, Tensor> Positions(const SamplePlane& plane, const torch::TensorOptions& options) {
  const Tensor x = (torch::arange(plane.width, options) + 0.5) * (2.0 / plane.width) - 1;
  const Tensor y = 1 - (torch::arange(plane.height, options) + 0.5) * (2.0 / plane.height);
  return {x.view({1, 1, 1, 1, -1}), y.view({1, 1, 1, -1, 1})};
}

// What the camera's radiance is multiplied with and the renderer does not know, [B, N, 1, H, W].
Tensor Gains(const std::vector<Drawn>& captures, const ViewBatch& truth,
             const torch::TensorOptions& options) {
  const auto [x, y] = Positions(truth.plane, options);
  const auto of = [&](auto field) { return OfShots(captures, options, field); };
  const Tensor angle = DirectionsOf(truth, options).half.slice(2, 2, 3).clamp(-1, 1).acos();
  const Tensor wave =
      (2 * std::numbers::pi * angle / of(&Disturbance::gain_period) + of(&Disturbance::gain_phase))
          .sin();
  return (of(&Shot::gradient_x) * x + of(&Shot::gradient_y) * y +
          of(&Shot::vignetting) * (x.square() + y.square() - 0.67) + of(&Disturbance::gain) * wave)
      .exp();
}

// Each picture looked up so many texels aside as its shot is, bilinearly; border texels continue.
Tensor Shifted(const Tensor& pictures, const std::vector<Drawn>& captures) {
  const auto options = pictures.options();
  const int64_t height = pictures.size(3), width = pictures.size(4);
  const auto along = [&](int64_t size) {
    return (torch::arange(size, options) + 0.5) * (2.0 / static_cast<double>(size)) - 1;
  };
  const auto moved = [&](double Shot::*field, int64_t size) {
    return OfShots(captures, options, field).flatten() * (2.0 / static_cast<double>(size));
  };
  const Tensor x = along(width).view({1, 1, -1}) + moved(&Shot::shift_x, width).view({-1, 1, 1});
  const Tensor y = along(height).view({1, -1, 1}) + moved(&Shot::shift_y, height).view({-1, 1, 1});
  const int64_t shots = x.size(0);
  const Tensor grid =
      torch::stack({x.expand({shots, height, width}), y.expand({shots, height, width})}, 3);
  namespace F = torch::nn::functional;
  return F::grid_sample(
             pictures.flatten(0, 1), grid,
             F::GridSampleFuncOptions().padding_mode(torch::kBorder).align_corners(false))
      .view(pictures.sizes());
}

// Each of a texel's four neighbours with its capture's weight.
Tensor Blurred(const Tensor& pictures, const std::vector<Drawn>& captures) {
  const Tensor weight = OfShots(captures, pictures.options(), &Disturbance::blur).flatten(0, 1);
  const Tensor flat = pictures.flatten(0, 1);
  const int64_t height = flat.size(2), width = flat.size(3);
  const Tensor wide = torch::replication_pad2d(flat, {1, 1, 1, 1});
  const auto part = [&](int64_t row, int64_t column) {
    return wide.slice(2, row, row + height).slice(3, column, column + width);
  };
  const Tensor sum = part(0, 1) + part(2, 1) + part(1, 0) + part(1, 2);
  return ((1 - 4 * weight) * flat + weight * sum).view(pictures.sizes());
}

// 8 bits by a tone curve that is about the one that is undone.
Tensor Quantised(const Tensor& radiance, const Tensor& gamma) {
  return ((radiance.clamp(0, 1).pow(1 / gamma) * 255).round() / 255).pow(kGamma);
}

// The rendered radiance [B, N, 3, H, W] as the cameras wrote it.
PhotographTensors Expose(const Tensor& radiance, const std::vector<Drawn>& captures,
                         const ViewBatch& truth) {
  const auto options = radiance.options();
  const auto of = [&](const auto& number) { return OfShots(captures, options, number); };
  const auto frame = [&](size_t k) {
    return of([k](const Shot& shot, const Disturbance&) { return shot.frame[k]; });
  };
  Tensor pictures = radiance * Gains(captures, truth, options) +
                    of(&Disturbance::noise) * torch::randn(radiance.sizes(), options);
  pictures = Blurred(Shifted(pictures, captures), captures);
  std::vector<float> clips;
  for (const Drawn& drawn : captures) clips.push_back(drawn.ldr ? 1 : 0);
  const Tensor ldr = torch::tensor(clips)
                         .view({-1, 1, 1, 1, 1})
                         .expand({-1, radiance.size(1), 1, 1, 1})
                         .to(options);
  const Tensor written = torch::where(
      ldr > 0, Quantised(pictures, kGamma * (1 + of(&Disturbance::gamma))), pictures.clamp_min(0));
  const auto [x, y] = Positions(truth.plane, options);
  const Tensor mask = (frame(0) * x + frame(1) * y <= frame(2)).to(options);
  return {written * mask, mask, ldr};
}

// The renderings of all shots, [B, N, 3, S, S]: of the maps, and where a capture has a second lobe,
// mixed with those of the maps of another roughness.
Tensor Render(const Tensor& encoded, const ViewBatch& batch, const std::vector<Drawn>& captures) {
  const Tensor maps = DecodeTexelsTorch(encoded);
  const Tensor one = RenderBatch(maps, batch);
  const bool all_one = std::all_of(captures.begin(), captures.end(), [](const Drawn& drawn) {
    return drawn.disturbance.second_lobe == 0;
  });
  if (all_one) return one;
  const auto of = [&](double Disturbance::*field) {
    return OfShots(captures, encoded.options(), field).slice(1, 0, 1);
  };
  const Tensor share = of(&Disturbance::second_lobe).clamp_max(0.7);
  Tensor wide = maps.clone();
  wide.select(1, kRoughness)
      .mul_(of(&Disturbance::second_lobe_width).flatten(1).unsqueeze(2))
      .clamp_(0.05, 1);
  return one * (1 - share) + RenderBatch(wide, batch) * share;
}

// Metals are said to be rare of many captures, of few with metal.
Tensor Conditions(const Tensor& encoded, const std::vector<Drawn>& captures) {
  constexpr double kLeastMetalF0 = 0.2, kLeastShare = 0.02;
  const double metal_code = 2 * std::sqrt(kLeastMetalF0) - 1;
  const Tensor metal = (encoded.slice(1, kEncodedSpecular, kEncodedRoughness).amax(1) > metal_code)
                           .to(encoded.options())
                           .mean({1, 2}) > kLeastShare;
  std::vector<float> of_metals, of_others, calibrated;
  for (const Drawn& drawn : captures) {
    of_metals.push_back(drawn.rare_if_metal ? 1 : 0);
    of_others.push_back(drawn.rare_if_not ? 1 : 0);
    calibrated.push_back(drawn.calibrated ? 1 : 0);
  }
  const auto row = [&](const std::vector<float>& values) {
    return torch::tensor(values).to(encoded.options());
  };
  return torch::stack({torch::where(metal, row(of_metals), row(of_others)), row(calibrated)}, 1);
}

}  // namespace

CaptureBatch PhotographMaps(const Tensor& encoded, int photographs, CaptureQuality quality,
                            Stream* random) {
  torch::NoGradGuard no_gradient;
  const int64_t count = encoded.size(0);
  const int height = static_cast<int>(encoded.size(2)), width = static_cast<int>(encoded.size(3));
  const bool clean = quality == CaptureQuality::kClean;
  const CaptureKind kind = clean ? CaptureKind::kDir : DrawKind(random);
  const double side = clean ? 2.0 : random->Uniform(1.0, 2.4);
  ViewBatch truth;
  truth.plane = {width, height, side, side, TexelSampling::kPixelCentres};
  truth.convention = {DiffuseWeight::kOne, FalloffOf(kind), TexelSampling::kPixelCentres};
  truth.views_per_element = photographs;
  ViewBatch believed = truth;
  std::vector<Drawn> captures;
  for (int64_t b = 0; b < count; ++b) {
    captures.push_back(clean ? CleanCapture(photographs, random)
                             : DrawCapture(kind, photographs, random));
    for (const Shot& shot : captures.back().shots) {
      truth.views.push_back(shot.view);
      believed.views.push_back(shot.believed);
    }
  }
  torch::manual_seed(static_cast<std::uint64_t>(random->Bits() >> 1));  // of the noise
  const PhotographTensors seen = Expose(Render(encoded, truth, captures), captures, truth);
  const FeatureTensors features = FeaturesOfTensors(seen, believed);
  return {features.planes, features.profiles, Conditions(encoded, captures)};
}

}  // namespace glint
