// The flash's power from the board's paper.
//
// A Lambertian spot of reflectance ρ at distance d from a point light of power P, under the angle
// θ, sends L = exposure · (P·cosθ/d² + ambient) · ρ/π toward the camera; so every spot of paper
// gives one estimate of P per channel. Medians over spots and photos leave out covered spots and
// the paper's gloss.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "base/camera/rigid3.h"
#include "calib/light/paper.h"

namespace glint {

struct LitPaper {
  Rigid3 camera_from_sample;
  Eigen::Vector3d light_in_camera_mm{0, 0, 0};
  double exposure = 1;  // relative to the photo for which the power is wanted
  std::vector<PaperSample> samples;
};

struct PowerOptions {
  double paper_reflectance = 0.85;
  Eigen::Vector3d ambient{0, 0, 0};  // irradiance
};

struct PowerEstimate {
  bool known = false;
  Eigen::Vector3d light_rgb{0, 0, 0};  // radiance·mm², median over photos
  std::vector<double> photo_power;     // mean of R, G, B by each photo alone; 0: no sample
  double spread = 0;                   // relative: 1.4826 · median deviation over photos
  int samples = 0;
};

PowerEstimate EstimatePower(const std::vector<LitPaper>& photos, const PowerOptions& options);

}  // namespace glint
