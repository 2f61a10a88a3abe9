// Cross-validation: the same camera from odd and from even photographs.
//
// Two calibrations from different photographs of the same camera differ by what their covariances
// predict, as long as the model of lens, board and shutter is true. A model that is not true bends
// each of them another way, and they differ by more: a fault that no residual shows (mrcal's
// documentation, "cross-validation"). Three figures:
//   difference  of the two projections over the part of the image where corners were seen, after
//               the motion of the camera's frame that goes with it (implied_motion.h)
//   predicted   root mean square that the covariances of both halves give it
//   held out    residual of each half's photographs under the other half's intrinsics, of which
//               only the poses are fitted
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "calib/bundle/bundle.h"
#include "calib/uncertainty/projection_uncertainty.h"

namespace glint {

// Above this ratio of difference and prediction the model, not the noise, limits the calibration …
inline constexpr double kTrustedRatio = 2;
// … unless they differ by less than any corner is found to.
inline constexpr double kNegligible_px = 0.02;

struct CameraDifference {
  int camera = 0;
  ImageGrid grid;
  std::vector<Eigen::Vector2d> difference_px;  // even − odd; NaN where one has no inverse
  std::vector<bool> seen;                      // within the hull of the corners
  double rms_px = 0;                           // of the difference, where corners were seen
  double predicted_px = 0;                     // likewise
  double ratio() const { return predicted_px > 0 ? rms_px / predicted_px : 0; }
  bool trusted() const { return ratio() <= kTrustedRatio || rms_px < kNegligible_px; }
};

struct CrossValidation {
  std::string problem;                    // why there is none; empty: there is
  std::vector<CameraDifference> cameras;  // those that were solved for
  // Per photo of the result: mean ‖residual‖² when held out; NaN: not used.
  std::vector<double> held_out_px2;
  double held_out_rms_px = 0;
  double ratio() const;  // the largest of the cameras
  bool trusted() const;  // all of them
};

// `result` solves `problem` under `options`; its inliers are used. At least four photographs of a
// camera are needed.
CrossValidation CrossValidate(const BundleProblem& problem, const BundleOptions& options,
                              const BundleResult& result);

// The inlier corners of the accepted photos; photos keep their indices, others are empty. `parity`
// 0, 1: only every second accepted photo of each camera, from the first, the second; −1: all.
BundleProblem Accepted(const BundleProblem& problem, const BundleResult& result, int parity = -1);

}  // namespace glint
