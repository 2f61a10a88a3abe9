// Captures of the estimator's training, drawn as programs meet them: geometry, disturbances, and
// what the program is told of both. Numbers alone; training_photographs.h makes the pictures.
#pragma once

#include <array>
#include <vector>

#include "base/reflectance/view.h"
#include "training/random.h"

namespace glint {

enum class CaptureKind {
  kPhone,  // a flash beside the lens, 3 to 5 half-widths away, tilts mostly below 20°
  kDir,    // DIR 2019: light at the camera, (x, y) in ±1.2 at one height, no fall-off
  kFree    // camera anywhere up to 45°, 1.4 to 3.6 half-widths away
};

// What a capture's views and pictures are wrong by, 0: not at all. Sizes are what real captures
// show (docs/training.md).
struct Disturbance {
  double exposure = 0;      // of ln exposure, by photograph
  double power = 0;         // of ln power, of all photographs
  double light = 0;         // of the light's position, relative to its distance
  double offset = 0;        // of the place that all lights share, likewise
  double ambient = 0;       // of the flash, irradiance
  double vignetting = 0;    // of ln radiance at the crop's corners
  double registration = 0;  // texels
  // The plane that the sample really lies in: height at its centre relative to its width, slopes.
  double plane_height = 0, plane_slope_x = 0, plane_slope_y = 0;
  double relief = 0;        // 1: the normals are a height field's, with parallax and cast shadows
  double shadow = 0;        // share of the light that a cast shadow takes
  double blur = 0;          // weight of each of a texel's neighbours
  double noise = 0;         // of the radiance
  double gamma = 0;         // of the photographs' tone curve, relative
  double toe = 0;           // radiance of which the tone curve's toe leaves half
  double jpeg_quality = 0;  // of the photographs' JPEG; 0: none
  // The model's own: a second lobe of other width with so much of the light, and a gain that
  // depends on the half vector's angle alone, as lobes of other shapes have.
  double second_lobe = 0, second_lobe_width = 1;
  double gain = 0, gain_period = 0.5, gain_phase = 0;
};

struct Shot {
  View view;                        // the truth
  View believed;                    // what the estimator is told
  double shift_x = 0, shift_y = 0;  // texels
  double gradient_x = 0, gradient_y = 0, vignetting = 0;
  // Where the frame ends: usable where frame_x·x + frame_y·y ≤ frame_end, x and y in [−1, 1].
  double frame_x = 0, frame_y = 0, frame_end = 1;
};

// Flags are 0 or 1.
struct DrawnCapture {
  Disturbance disturbance;
  std::vector<Shot> shots;
  double ldr = 1;            // clips at 1
  double calibrated = 1;     // the light is
  double power_guessed = 0;  // from the photographs, as programs do (light_power.h)
  // Whether metals are said to be rare, if there are any and if not.
  double rare_if_metal = 0, rare_if_not = 0;
};

CaptureKind DrawCaptureKind(Stream* random);
LightFalloff FalloffOf(CaptureKind kind);

DrawnCapture DrawCapture(CaptureKind kind, int photographs, Stream* random);

// DIR 2019's geometry, undisturbed: for validation.
DrawnCapture CleanCapture(int photographs, Stream* random);

}  // namespace glint
