// The sample's own plane, and what is left to bring each photograph into one frame with the others,
// from the photographs alone: the texture of a flat sample lies at one place in all of them.
//
// Photographs that are rectified on a wrong plane are displaced against each other by parallax,
// p + z (p − c) / h of a camera at height h over c, which a height and two slopes explain; what
// poses and lenses have wrong is a small homography a photograph, with a Gaussian prior. The plane
// is the one on which windows' textures have most in common (window_heights.h), homographies take
// each photograph to where the others predict it (predicted_shifts.h), in turns; photographs that
// may be further out of place are first brought near by pairs (place_problem.h). docs/model.md,
// "Where photographs lie".
//
// What all photographs are displaced by together is the sample's own place and stays as it is.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "base/model/registration.h"
#include "calib/registration/sample_place.h"

namespace glint {

// A photograph as it looks on the assumed plane z = 0, from the top, rows from +y on. Best
// constants::kRegistrationSide_px pixels along the sample's longer side (times the margin); fewer
// are right where the photograph has no more.
struct TopView {
  int width = 0, height = 0;
  std::vector<float> radiance;  // [H·W], linear, 1 where an 8-bit photograph clips
  Eigen::Vector3d camera_mm{0, 0, 1};
};

struct RegistrationProblem {
  double sample_width_mm = 0, sample_height_mm = 0;
  // The views show the plane this many times as wide and as high as the sample, centred.
  double margin = 1;
  std::vector<TopView> views;

  // Gaussian priors. `height_sd_mm` 0: the plane is held at `height_mm`, without slopes.
  double height_mm = 0, height_sd_mm = 1;
  double slope_sd = constants::kPlaneSlopeSd;
  // Whether samples that lie exactly in the plane z = height_mm are as usual as all others: those
  // on a board are, pictures that somebody rectified are not.
  bool often_as_said = true;
  // Displacement of a photograph's corners beside the plane; 0: none.
  double homography_sd_mm = 0;
  // Whether somebody may have touched the sample between photographs (sample_moves.h).
  bool may_have_moved = false;
};

struct SampleRegistration {
  PlaneValues plane{0, 0, 0};
  Eigen::Matrix3d plane_covariance = Eigen::Matrix3d::Zero();
  // By view: the sample's point p is shown where a flat sample in that plane would have the point
  // homography · (p, 1), millimetres.
  std::vector<Eigen::Matrix3d> homographies;

  // By view, in the assumed plane and before all else; empty where the sample was not moved.
  std::vector<SampleMove> moves;
  // By view: 0 shows the texture of most, 1 another one, −1: cannot be told. Empty where all show
  // one.
  std::vector<int> textures;

  bool told = false;  // by the photographs, not the prior alone
  // Windows of pairs of views in which the texture's displacement could be measured, and how many
  // there were in all.
  int measured = 0, windows = 0;
  // Median displacement of pairs as given, and as registered.
  double displaced_before_mm = 0, displaced_after_mm = 0;

  double height_sd_mm() const;
};

// Nothing but the prior: the photographs as they are, on its plane.
SampleRegistration Unregistered(const RegistrationProblem& problem);

// With fewer than two views, with fewer than four whose homographies are free by more than a pixel
// of 512, or without texture, the result is the prior. The same for any number
// of threads. Throws std::invalid_argument: views of different sizes, cameras below the plane.
SampleRegistration RegisterSample(const RegistrationProblem& problem, int threads);

}  // namespace glint
