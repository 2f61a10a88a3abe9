#include "fitting/training/training_photographs.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "fitting/encoding/encoding_torch.h"
#include "fitting/estimator/photograph_features.h"
#include "fitting/render/render_autograd.h"

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
};

Vec3d Direction(double tilt, double azimuth) {
  return {std::sin(tilt) * std::cos(azimuth), std::sin(tilt) * std::sin(azimuth), std::cos(tilt)};
}

Disturbance DrawDisturbance(Stream* random) {
  Disturbance d;
  const double size = random->Uniform() < 0.2 ? 0.05 : random->Uniform(0.3, 1.4);
  d.exposure = 0.05 * size;
  d.power = random->Uniform() < 0.5 ? 0.12 * random->Normal() : 0.0;
  d.light = 0.03 * size;
  d.ambient = 0.03 * size * random->Uniform();
  d.vignetting = 0.04 * size;
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
  Drawn drawn;
  drawn.disturbance = DrawDisturbance(random);
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

// One plane looked up `x`, `y` texels aside, bilinearly; border texels continue.
std::vector<float> Shifted(const std::vector<float>& plane, int width, int height, double x,
                           double y) {
  const auto row_of = [&](int row) { return std::clamp(row, 0, height - 1) * width; };
  const auto column_of = [&](int column) { return std::clamp(column, 0, width - 1); };
  const int left = static_cast<int>(std::floor(x)), top = static_cast<int>(std::floor(y));
  const auto u = static_cast<float>(x - left), v = static_cast<float>(y - top);
  std::vector<float> out(plane.size());
  for (int row = 0; row < height; ++row) {
    const float* a = plane.data() + row_of(row + top);
    const float* b = plane.data() + row_of(row + top + 1);
    for (int column = 0; column < width; ++column) {
      const int c0 = column_of(column + left), c1 = column_of(column + left + 1);
      out[static_cast<size_t>(row) * width + column] =
          (1 - v) * ((1 - u) * a[c0] + u * a[c1]) + v * ((1 - u) * b[c0] + u * b[c1]);
    }
  }
  return out;
}

// Each of a texel's four neighbours with weight `weight`.
void Blur(std::vector<float>* plane, int width, int height, double weight) {
  const auto w = static_cast<float>(weight);
  const std::vector<float> from = *plane;
  for (int row = 0; row < height; ++row) {
    const int up = std::max(row - 1, 0) * width, down = std::min(row + 1, height - 1) * width;
    for (int column = 0; column < width; ++column) {
      const int i = row * width + column;
      const int left = column > 0 ? i - 1 : i, right = column + 1 < width ? i + 1 : i;
      (*plane)[i] = (1 - 4 * w) * from[i] +
                    w * (from[up + column] + from[down + column] + from[left] + from[right]);
    }
  }
}

float Quantised(double radiance, double gamma) {
  const double code = std::round(255 * std::pow(std::clamp(radiance, 0.0, 1.0), 1 / gamma));
  return static_cast<float>(std::pow(code / 255, kGamma));
}

// The rendered radiance as the camera wrote it.
Photograph Expose(const float* radiance, const Shot& shot, const Drawn& drawn,
                  const SamplePlane& plane, const ReflectanceConvention& convention,
                  Stream* random) {
  const Disturbance& d = drawn.disturbance;
  const size_t texels = static_cast<size_t>(plane.width) * plane.height;
  Photograph photograph{shot.believed, drawn.ldr, {}, std::vector<float>(texels, 1.0f)};
  std::vector<float> gain(texels);
  for (int row = 0; row < plane.height; ++row) {
    for (int column = 0; column < plane.width; ++column) {
      const size_t i = static_cast<size_t>(row) * plane.width + column;
      const double x = 2 * plane.x_mm(column) / plane.width_mm;
      const double y = 2 * plane.y_mm(row) / plane.height_mm;
      const auto& [a, b, c] = shot.frame;
      if (a * x + b * y > c) photograph.mask[i] = 0;
      double log_gain =
          shot.gradient_x * x + shot.gradient_y * y + shot.vignetting * (x * x + y * y - 0.67);
      if (d.gain != 0) {
        const TexelGeometry<double> g =
            TexelGeometryInView(shot.view, convention.falloff, plane.x_mm(column), plane.y_mm(row));
        const double angle = std::acos(std::clamp(g.half[2], -1.0, 1.0));
        log_gain += d.gain * std::sin(2 * std::numbers::pi * angle / d.gain_period + d.gain_phase);
      }
      gain[i] = static_cast<float>(std::exp(log_gain));
    }
  }
  const double gamma = kGamma * (1 + d.gamma);
  for (size_t c = 0; c < 3; ++c) {
    std::vector<float> picture(radiance + c * texels, radiance + (c + 1) * texels);
    for (size_t i = 0; i < texels; ++i) {
      picture[i] *= gain[i];
      if (d.noise > 0) picture[i] += static_cast<float>(d.noise * random->Normal());
    }
    if (d.registration > 0) {
      picture = Shifted(picture, plane.width, plane.height, shot.shift_x, shot.shift_y);
    }
    if (d.blur > 0) Blur(&picture, plane.width, plane.height, d.blur);
    for (float& value : picture) {
      value = drawn.ldr ? Quantised(value, gamma) : std::max(0.0f, value);
    }
    photograph.rgb.insert(photograph.rgb.end(), picture.begin(), picture.end());
  }
  return photograph;
}

// The renderings of all shots, [B, N, 3, S, S]: of the maps, and where a capture has a second lobe,
// mixed with those of the maps of another roughness.
Tensor Render(const Tensor& encoded, const ViewBatch& batch, const std::vector<Drawn>& captures) {
  const Tensor maps = DecodeTexelsTorch(encoded);
  const Tensor one = RenderBatch(maps, batch);
  const auto count = static_cast<int64_t>(captures.size());
  Tensor share = torch::zeros({count, 1, 1, 1, 1}), width = torch::ones({count, 1, 1});
  for (int64_t b = 0; b < count; ++b) {
    const Disturbance& d = captures[static_cast<size_t>(b)].disturbance;
    share[b].fill_(std::min(0.7, d.second_lobe));
    width[b].fill_(d.second_lobe_width);
  }
  if (share.max().item<float>() == 0) return one.contiguous();
  Tensor wide = maps.clone();
  wide.select(1, kRoughness).mul_(width).clamp_(0.05, 1);
  return (one * (1 - share) + RenderBatch(wide, batch) * share).contiguous();
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
  ViewBatch batch;
  batch.plane = {width, height, side, side, TexelSampling::kPixelCentres};
  batch.convention = {DiffuseWeight::kOne, FalloffOf(kind), TexelSampling::kPixelCentres};
  batch.views_per_element = photographs;
  std::vector<Drawn> captures;
  for (int64_t b = 0; b < count; ++b) {
    captures.push_back(clean ? CleanCapture(photographs, random)
                             : DrawCapture(kind, photographs, random));
    for (const Shot& shot : captures.back().shots) batch.views.push_back(shot.view);
  }
  const Tensor rendered = Render(encoded, batch, captures);
  CaptureBatch result{torch::empty({count, photographs, kFeaturePlanes, height, width}),
                      torch::empty({count, photographs, kProfileValues})};
  for (int64_t b = 0; b < count; ++b) {
    const Drawn& drawn = captures[static_cast<size_t>(b)];
    for (int64_t n = 0; n < photographs; ++n) {
      const Photograph photograph =
          Expose(rendered[b][n].data_ptr<float>(), drawn.shots[static_cast<size_t>(n)], drawn,
                 batch.plane, batch.convention, random);
      const PhotographFeatures features = FeaturesOf(photograph, batch.plane, batch.convention);
      std::copy(features.planes.begin(), features.planes.end(),
                result.features[b][n].data_ptr<float>());
      std::copy(features.profile.begin(), features.profile.end(),
                result.profiles[b][n].data_ptr<float>());
    }
  }
  return result;
}

}  // namespace glint
