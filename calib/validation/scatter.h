// Monte-Carlo check of the covariances: what repetition scatters against what was predicted.
//
// A solved calibration is taken for the truth. Its corners, put where it predicts them, are given
// Gaussian noise, and it is solved anew, many times. For each group of quantities the root of the
// mean of (deviation / predicted σ)² is near 1 when the predictions are right.
//
// Terms that a prior holds (FULL_OPENCV's radial ones) do not scatter with the noise: their σ says
// how far the truth may be from them. For those the truth is drawn too, anew each time, from what
// the solved calibration leaves open: where its photographs tell nothing, that is the prior.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "calib/bundle/bundle.h"

namespace glint {

struct ScatterLine {
  std::string quantity;
  double scatter = 0;    // root mean squared deviation from the truth
  double predicted = 0;  // root mean predicted variance
  double ratio() const { return predicted > 0 ? scatter / predicted : 0; }
};

struct Scatter {
  int draws = 0;
  std::vector<ScatterLine> intrinsics;   // each free parameter of camera 0
  ScatterLine rotation, position;        // of all photos: degrees, mm
  ScatterLine bend;                      // mm; predicted 0: not solved for
  std::vector<ScatterLine> projections;  // px, after the implied motion: centre, whole image
  ScatterLine sample;                    // mm, places on the sample over all photos
  std::string Text() const;
};

// `truth` solves `problem` under `options`; camera 0 is looked at. `sample_size_mm` is for the line
// on the sample. Rejection is switched off: it is not what is checked. `draw_camera`: the true
// intrinsics of camera 0 are drawn from their covariance in `truth`; for boards that are flat.
Scatter MeasureScatter(const BundleProblem& problem, const BundleResult& truth,
                       const BundleOptions& options, const Eigen::Vector2d& sample_size_mm,
                       double noise_px, int draws, std::uint64_t seed, bool draw_camera = false);

}  // namespace glint
