// The plane that most of a cloud of points lies on.
//
// RANSAC (Fischler, Bolles 1981) with MSAC's score, then re-weighted least squares with Tukey's
// biweight, whose scale comes from the residuals' median. Deterministic: the sampling starts from a
// fixed number.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

namespace glint {

struct CloudPoint {
  Eigen::Vector3d position;
  double weight = 1;  // not negative
};

struct PlaneOptions {
  double threshold = 0;      // a point farther off the plane is none of it; in the points' unit
  double min_share = 0.25;   // of the points' weight that must lie on the plane
  size_t min_points = 12;    // on the plane
  double min_spread = 0.05;  // of the points on it: the smaller extent over the larger
  int trials = 2000;
};

struct PlaneFit {
  Eigen::Vector3d normal{0, 0, 1};  // unit; its sign is the caller's to choose
  double offset = 0;                // normal · x = offset on the plane
  std::vector<bool> inlier;         // per point: within the threshold
  double rms = 0;                   // distance of the inliers, root mean square
  double share = 0;                 // of the weight
  size_t inliers = 0;
  std::string problem;  // empty: a plane was found; else why not

  double Distance(const Eigen::Vector3d& x) const { return normal.dot(x) - offset; }
};

PlaneFit FitPlane(const std::vector<CloudPoint>& points, const PlaneOptions& options);

}  // namespace glint
