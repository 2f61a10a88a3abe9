// What the parts of the light's solution share.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "calib/light/light.h"
#include "calib/light/light_model.h"

namespace glint::light {

struct Spot {
  SpotGeometry geometry;
  Eigen::Vector3d seen;
  Eigen::Vector2d point_px;
  int cluster = 0;  // block of squares of a photo
  int pixels = 1;
  bool inlier = true;
  double sigma[3] = {1, 1, 1};  // of `seen`, by the current prediction
};

struct PhotoState {
  bool used = false;
  int camera = 0;
  bool clips = true;
  double exif = 0;                        // exposure relative to the first photo's; 0: not known
  Eigen::Vector3d log_exposure{0, 0, 0};  // of R, G, B
  Eigen::Vector3d flash_mm{0, 0, 0};      // where State::own_flashes
  int turns = 0;                          // of the pixels, see turned_photos.h
  bool contradicts = false;               // left out: see contradictions.h
  double zoom = 1;                        // that explains the contradiction
  double kept_share = 1;                  // of its spots, see thinned.h
  std::vector<Spot> spots;
};

// Values of the parameter blocks, and which are held.
struct State {
  Eigen::Vector3d flash_mm{0, 0, 0};
  Eigen::Vector3d log_q{0, 0, 0};
  Eigen::Vector3d ambient{0, 0, 0};  // a / reference
  double gloss = 0;                  // lobe's reflectance over the paper's
  double smear = 0;                  // see SmearOf
  Eigen::Vector3d tone{0, 0, 0};     // see Toned
  std::vector<Eigen::Vector3d> vignetting;
  std::vector<PhotoState> photos;
  double reference = 1;  // 1/mm²: median of cosθ/d²
  int first = 0;         // the photo of exposure 1
  bool srgb = false;     // spots are as sRGB's curve reads them
  bool flash_along_free = false;
  bool own_flashes = false;  // each photo has a flash of its own, in its picture's frame
  bool hold_flash = false, hold_ambient = false, hold_gloss = false, hold_tone = true;
  std::vector<bool> hold_vignetting;
  double scale = 1;  // standard deviation of residuals in units of Spot::sigma
  // … as the solution weighs them: neighbouring spots share errors, so that a hundred of a block
  // tell no more than a few; what is known beforehand counts that much more.
  double weighing_scale() const { return shared * scale; }
  double shared = 5;

  std::vector<double> Prediction(const PhotoState& photo, const Spot& spot) const;  // empty: none
};

// Weak knowledge that keeps what is nearly undetermined within reason; standard deviations.
struct Prior {
  double flash_across_mm = 50;    // a phone's lies within 15, a camera's own flash 80 beside it
  double flash_along_mm = 2;      // a phone's flash lies in the lens's plane, or where told …
  double flash_free_mm = 50;      // … unless the paper contradicts that, see Choose in light.cc
  double vignetting = 1;          // v1; v2 and v3 about those of (1 + t·r²)⁻² with its v1:
  double vignetting_form = 0.01;  // the cosine-to-the-fourth law with a strength of its own
  double ambient = 0.5, gloss = 0.05, smear = 0.05;
  double exif = 0.03;                 // cameras round exposure times and ISO
  double white_balance = 0.01;        // between channels
  double tone[3] = {0.2, 0.1, 0.05};  // where it is free
};
inline constexpr Prior kPrior;

// Free scalar parameters in order, for the covariance.
struct Layout {
  // First column; −1: held.
  int flash = -1, log_q = -1, ambient = -1, gloss = -1, smear = -1, tone = -1;
  std::vector<int> vignetting, exposure;  // per camera; per photo, of R, G, B
  int columns = 0;
};
Layout LayoutOf(const State& state);

// Whether a spot of that radiance is so bright that pixels of it may have clipped.
bool MayClip(const std::vector<double>& predicted);

// Residuals' scale from the inliers' median; new weights from the prediction.
void Reweigh(State* state);

// A photo without enough spots leaves; the first that is left gets exposure 1. False: none is left.
bool DropPhotos(const LightOptions& options, State* state);
// Robust solutions until nothing changes sides, then plain least squares. False: nothing is left.
bool SolveRobustly(const LightOptions& options, State* state, int* rounds);

// One Ceres solve from the state on. `robust`: Cauchy's loss.
void Solve(const LightOptions& options, bool robust, State* state);

// Half of the squared residuals of all spots of used photos, with Cauchy's loss, and of the priors:
// to compare solutions under one scale of residuals. Infinite where a spot cannot be predicted.
double Misfit(const LightOptions& options, const State& state, double scale);

// Covariance of the layout's columns, see light.h.
Eigen::MatrixXd Covariance(const LightProblem& problem, const LightOptions& options,
                           const State& state, const Layout& layout);

// Holds, in `held`, the least important of the terms that are too uncertain to be of use, and says
// why. False: none is.
bool HoldOne(const State& state, const Layout& layout, const Eigen::MatrixXd& covariance,
             State* held, std::vector<std::string>* words);

void FillEstimate(const LightProblem& problem, const LightOptions& options, const State& state,
                  const Layout& layout, const Eigen::MatrixXd& covariance, LightEstimate* estimate);

}  // namespace glint::light
