// The flash, the lens's fall-off, the exposures and the room's light from the board's paper.
//
// The board's white is a known plane (or two parabolas, where the board is bent) of one material
// that every photograph shows. A spot X of it sends to a pixel at distance r from the principal
// point
//
//   L = e · V(r) · q · ( cosθ/d² · (1 + g) + a ),   V(r) = 1 + v1·r² + v2·r⁴ + v3·r⁶
//
// with e the photo's exposure (the first photo's is 1), d and θ distance and angle of the flash,
// q = power · reflectance/π per channel, a = ambient irradiance / power per channel, and g the
// paper's gloss over its diffuse reflection: a GGX lobe of roughness 0.6 and one unknown strength
// (reflectance/brdf.h's formula). Unknown are the flash's position in the camera's frame, q, a, v,
// g's strength, every e, and how much of the ink's blur (lens, JPEG) reaches spots near it: one
// least squares problem. Outliers (covered or shaded spots, gloss of ink, what clips) are found
// with Cauchy's loss and rejected; the final solution is plain least squares on the rest. Its
// covariance is the sandwich (JᵀJ)⁻¹ (Σ gₛgₛᵀ) (JᵀJ)⁻¹ over blocks s of 3 × 3 squares of each
// photo, gₛ the gradient of a block's spots: errors that neighbours share (blur of the ink, JPEG, a
// crease) count as one; to it come smooth errors of 0.1 % (light_covariance.cc), which residuals
// do not show. Two curves are tried where a photograph may be stored by either (gamma 2.2, sRGB):
// between 0.4 and 0.8 they differ by 1 to 3 % in their exponent, which would move the flash by 5 to
// 8 mm along the axis. Only the product of power and reflectance shows; the paper's reflectance is
// taken as known.
#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>
#include <string>
#include <vector>

#include "base/camera/camera_model.h"
#include "base/camera/rigid3.h"
#include "calib/bundle/bundle.h"
#include "calib/light/paper.h"
#include "calib/light/tone_curve.h"

namespace glint {

struct LightPhoto {
  std::string name;
  int camera = 0;             // index into LightProblem::cameras
  Rigid3 camera_from_sample;  // of the stored picture
  double exposure = 0;        // by EXIF, up to a common factor; 0: not known
  // Clockwise quarter turns that its pixels may have had without EXIF's knowledge, the expected one
  // first; surely: none of them is expected more.
  std::vector<int> possible_turns{0};
  bool surely_turned = false;
  bool clips = true;  // at radiance 1
  std::vector<PaperSample> samples;
};

struct LightProblem {
  std::vector<Camera> cameras;  // of the stored pictures; their vignetting is the start
  std::vector<LightPhoto> photos;
  std::optional<BoardBend> bend;  // of the paper; none: it is flat
};

struct LightOptions {
  double paper_reflectance = 0.85;
  Eigen::Vector3d offset_mm{0, 0, 0};  // of the flash: start, and value where it is held
  Eigen::Vector3d power{0, 0, 0};      // given; then the paper's reflectance is free. Zeros: free
  std::optional<Eigen::Vector3d> ambient;  // irradiance, given; nullopt: free
  double reject_sigmas = 5;                // a spot is an outlier beyond
  bool tone_known = false;                 // the encoding is linear by nature, or was measured
  // Samples were read with gamma 2.2 for want of anything better, and may be sRGB's.
  bool perhaps_srgb = false;
  size_t spots_per_photo = 1200;  // that are solved for; all are judged by the solution
  int min_samples = 12;           // a photo with fewer inliers gets no exposure
};

struct LightOfPhoto {
  std::string name;
  bool used = false;
  Estimate exposure{1, 0};          // relative to the first used photo's
  double exif_exposure = 0;         // the same by EXIF; 0: not known
  Eigen::Vector3d colour{1, 1, 1};  // exposures of R, G, B over their mean: the white balance
  int turns = 0;                    // of its pixels
  // Its exposure contradicts EXIF and all others: it has no say. `zoom`: the enlargement, unknown
  // to EXIF, that would explain it and its own fall-off of the light; 1: none does.
  bool contradicts = false;
  double zoom = 1;
  int samples = 0, inliers = 0;
  int unlit = 0;  // of those that are no inliers: darker or brighter than predicted, unclipped
  double rms_percent = 0;  // of the inliers' residuals, relative to what is predicted
  struct Spot {
    Eigen::Vector2d point_px;  // in the stored picture
    Eigen::Vector3d relative;  // seen / predicted − 1
    bool inlier = true;
  };
  std::vector<Spot> spots;
};

struct LightEstimate {
  bool known = false;  // false: `problem` says why, and nothing else holds
  std::string problem;
  std::array<Estimate, 3> flash_in_camera_mm;
  std::array<Estimate, 3> power_rgb;    // σ without that of the paper's reflectance
  std::array<Estimate, 3> ambient_rgb;  // irradiance; never negative
  std::array<Estimate, 3> paper_rgb;    // reflectance; σ 0 unless the power is given
  bool srgb = false;                    // sRGB's curve explains the paper better than gamma 2.2
  std::optional<ToneCurve> tone;        // where the paper contradicts the encoding, or sRGB's curve
  bool flash_along_free = false;        // the paper insists on a flash before or behind the lens
  Estimate smear;  // share of its light that paper beside ink loses to blur and JPEG
  Estimate gloss;  // the lobe's reflectance at normal incidence
  // Per camera: v1, v2, v3, and the largest σ of V(r) up to the farthest spot that was seen.
  std::vector<std::array<Estimate, 3>> vignetting;
  std::vector<double> vignetting_sigma;
  std::vector<Eigen::Matrix3d> vignetting_covariance;
  std::vector<LightOfPhoto> photos;  // as in the problem
  std::vector<std::string> held;     // what was held, and why
  double rms_percent = 0;
  int samples = 0, inliers = 0, rounds = 0;
};

// Terms that the photographs do not determine (too few of them, all from one height) are held at
// their start, the least important first: gloss, ambient, vignetting, flash. Deterministic.
LightEstimate EstimateLight(const LightProblem& problem, const LightOptions& options = {});

}  // namespace glint
