// What the files of this folder share.
#pragma once

#include <array>
#include <utility>
#include <vector>

#include "calib/bundle/bundle.h"

namespace glint::bundle {

// A solution in the making. rotation0 and pose: see ReprojectionError.
struct PhotoState {
  bool accepted = true;
  std::string rejected;
  Eigen::Matrix3d rotation0 = Eigen::Matrix3d::Identity();
  std::array<double, 6> pose{};
  std::vector<bool> inlier;  // per corner

  Rigid3 camera_from_sample() const;
  void Rebase();  // moves w into rotation0
};

struct State {
  std::vector<Camera> cameras;
  std::vector<PhotoState> photos;
  BoardBend bend;  // flat: heights of 0
};

// A weak prior on each height of a bend that is solved for, in mm: a sheet on a table rarely rises
// by more than a twentieth of its size.
double BendPriorSigma(const BoardBend& bend);

// Focal lengths and poses to start from. Photos without a pose are marked as rejected.
State Start(const BundleProblem& problem, const BundleOptions& options);

// Indices of the parameters that are solved for (empty: a known camera, or none of its photos
// left).
std::vector<int> FreeParameters(const BundleProblem& problem, const BundleOptions& options,
                                int camera);

// A weak prior on radial distortion terms, as (index, 1/σ): a term rarely moves the picture's
// corners by more than half of their radius. What the corners determine it leaves alone; it keeps
// terms that cancel each other (FULL_OPENCV's numerator and denominator) from running away. In
// residuals, a unit of 1/σ weighs as much as the noise of one coordinate.
std::vector<std::pair<int, double>> DistortionPrior(const Camera& camera,
                                                    const std::vector<int>& free);

enum class Refine { kFocalAndPoses, kAll };
// One Ceres solve over accepted photos and inliers. loss_scale_px ≤ 0: plain least squares.
// sigma_px: noise of one coordinate, for the prior.
void Solve(const BundleProblem& problem, const BundleOptions& options, Refine refine,
           double loss_scale_px, double sigma_px, State* state);

// Seen − predicted, for every corner of a photo; points behind the camera give 1e6 px.
std::vector<Eigen::Vector2d> Residuals(const BundlePhoto& photo, const State& state,
                                       const PhotoState& photo_state);

// Robust standard deviation of one coordinate, from the median length of the inliers' residuals.
double RobustSigma(const BundleProblem& problem, const State& state);

// Marks outlier corners and photos anew; true when anything changed.
bool Reject(const BundleProblem& problem, const BundleOptions& options, double sigma_px,
            State* state);

// Fills sigmas and covariances of `result`, whose other fields are set. Returns per camera the
// relative standard deviation that its focal length would have with residuals of at least 0.05 px
// (0: held; infinite: undetermined).
std::vector<double> Covariance(const BundleProblem& problem, const BundleOptions& options,
                               const State& state, BundleResult* result);

}  // namespace glint::bundle
