#include "training/capture_draw.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace glint {
namespace {

constexpr double kMostTilt = std::numbers::pi / 4;

bool Happens(double probability, Stream* random) { return random->Uniform() < probability; }

Vec3d Direction(double tilt, double azimuth) {
  return {std::sin(tilt) * std::cos(azimuth), std::sin(tilt) * std::sin(azimuth), std::cos(tilt)};
}

// The sample is thicker than the paper whose plane was calibrated, or bent: real sets show heights
// of −1.4 to .7 % of the width, and tilts that lift its edges as much (docs/training.md).
void DrawPlane(double size, Stream* random, Disturbance* d) {
  d->plane_height = 0.007 * size * random->Normal();
  d->plane_slope_x = 0.01 * size * random->Normal();
  d->plane_slope_y = 0.01 * size * random->Normal();
}

// What the camera's own processing does: a toe that crushes black (valleys of leather show a
// radiance of .000 to .004 where .008 to .014 arrives), and JPEG.
void DrawProcessing(double size, Stream* random, Disturbance* d) {
  d->gamma = 0.04 * size * random->Normal();
  if (Happens(0.5, random)) d->toe = 0.015 * size * random->Uniform();
  if (Happens(0.4, random)) d->jpeg_quality = random->Uniform(85, 97);
}

// Gloss on a wide glow or a sharp highlight in one, as coated paper, foil and varnish have them.
void DrawModelDiscrepancy(double size, Stream* random, Disturbance* d) {
  if (Happens(0.4, random)) {
    d->second_lobe = 0.5 * size * random->Uniform();
    d->second_lobe_width =
        Happens(0.6, random) ? random->Uniform(1.5, 3) : random->Uniform(0.3, 0.7);
  }
  d->gain = 0.12 * size * random->Normal();
  d->gain_period = random->Uniform(0.3, 1.2);
  d->gain_phase = random->Uniform(0, 2 * std::numbers::pi);
  if (Happens(0.35, random)) {
    d->relief = 1;
    d->shadow = random->Uniform(0.4, 0.95);
  }
}

// One size scales all of a capture's disturbances, so that clean captures occur beside bad ones: of
// those whose light was calibrated four in ten are nearly clean; of the others the light's power,
// and the place that all its lights share, are about right only.
Disturbance DrawDisturbance(bool calibrated, Stream* random) {
  Disturbance d;
  const bool clean = calibrated && Happens(0.4, random);
  const double size = clean ? 0.05 : random->Uniform(0.3, calibrated ? 1.0 : 1.5);
  // ±10 % where nobody measured them; a camera's stated exposures are less wrong.
  d.exposure = calibrated ? 0.04 * size : 0.1 * std::min(1.0, size);
  d.power = (calibrated ? 0.02 * size : 0.3) * random->Normal();
  d.light = (calibrated ? 0.02 : 0.03) * size;
  d.offset = calibrated ? 0.0 : 0.05;
  d.ambient = 0.03 * size * random->Uniform();
  d.vignetting = (calibrated ? 0.04 : 0.1) * size;
  // Photographs of real sets stay displaced by .17 to .35 texels at 256² once one plane explains
  // the rest: the difference of two, in two directions, is twice this.
  d.registration = 0.2 * size;
  DrawPlane(size, random, &d);
  d.blur = Happens(0.5, random) ? 0.12 * size * random->Uniform() : 0.0;
  d.noise = Happens(0.5, random) ? 0.008 * size * random->Uniform() : 0.0;
  DrawProcessing(size, random, &d);
  DrawModelDiscrepancy(size, random, &d);
  return d;
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
      tilt = first                   ? 0.10 * std::abs(random->Normal())
             : Happens(0.75, random) ? random->Uniform(0, 0.35)
                                     : random->Uniform(0, kMostTilt);
      break;
    case CaptureKind::kFree:
      tilt =
          Happens(0.4, random) ? 0.12 * std::abs(random->Normal()) : random->Uniform(0, kMostTilt);
      break;
  }
  Vec3d camera = Direction(std::min(tilt, kMostTilt), azimuth);
  for (double& x : camera) x *= distance;
  return camera;
}

}  // namespace

CaptureKind DrawCaptureKind(Stream* random) {
  const double u = random->Uniform();
  return u < 0.5 ? CaptureKind::kPhone : u < 0.8 ? CaptureKind::kDir : CaptureKind::kFree;
}

LightFalloff FalloffOf(CaptureKind kind) {
  return kind == CaptureKind::kDir ? LightFalloff::kNone : LightFalloff::kInverseSquare;
}

DrawnCapture DrawCapture(CaptureKind kind, int photographs, Stream* random) {
  // With metals in a tenth of the materials, metals are found in 1 % of the captures of which they
  // are said to be rare, and in 3 in 10 of the others.
  constexpr double kRareIfMetal = 0.05, kRareIfNot = 0.75;
  constexpr double kCalibrated = 0.5, kPowerGuessed = 0.6, kLdr = 0.93;
  DrawnCapture drawn;
  const bool calibrated = Happens(kCalibrated, random);
  drawn.calibrated = calibrated;
  drawn.power_guessed = Happens(kPowerGuessed, random) && !calibrated;
  drawn.rare_if_metal = Happens(kRareIfMetal, random);
  drawn.rare_if_not = Happens(kRareIfNot, random);
  drawn.disturbance = DrawDisturbance(calibrated, random);
  drawn.ldr = Happens(kLdr, random);
  const Disturbance& d = drawn.disturbance;
  const bool phone = kind == CaptureKind::kPhone;
  const double usual = phone ? random->Uniform(2.6, 5.2) : random->Uniform(1.4, 3.6);
  const double beside = kind == CaptureKind::kDir ? 0.0 : usual * random->Uniform(0, 0.12);
  const double flash_azimuth = random->Uniform(0, 2 * std::numbers::pi);
  // A part of a larger sample is seen from elsewhere than above its middle.
  const bool part = Happens(0.5, random);
  const double part_x = part ? random->Uniform(-0.6, 0.6) : 0;
  const double part_y = part ? random->Uniform(-0.6, 0.6) : 0;
  // Phones clip: half a stop is usual, a stop and more happens, and what is rough then shows the
  // same white as a mirror's highlight.
  const double exposure = std::exp(0.15 + 0.5 * random->Normal());
  const bool frames_end = Happens(0.2, random);
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
    if (frames_end && Happens(0.5, random)) {
      const double azimuth = random->Uniform(0, 2 * std::numbers::pi);
      shot.frame_x = std::cos(azimuth);
      shot.frame_y = std::sin(azimuth);
      shot.frame_end = random->Uniform(0, 0.9);
    }
    drawn.shots.push_back(shot);
  }
  return drawn;
}

DrawnCapture CleanCapture(int photographs, Stream* random) {
  DrawnCapture drawn;
  for (int i = 0; i < photographs; ++i) {
    const double x = i == 0 ? 0 : random->Uniform(-kDirJitter, kDirJitter);
    const double y = i == 0 ? 0 : random->Uniform(-kDirJitter, kDirJitter);
    Shot shot;
    shot.view = shot.believed = DirView(x, y);
    drawn.shots.push_back(shot);
  }
  return drawn;
}

}  // namespace glint
