#include "calib/validation/cross_validation.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <opencv2/imgproc.hpp>

#include "base/errors/errors.h"
#include "calib/uncertainty/implied_motion.h"
#include "calib/uncertainty/projection_jacobian.h"
#include "calib/uncertainty/uncertainty_picture.h"

namespace glint {
namespace {

constexpr int kLeastPhotos = 4;

// Photos without corners are left out of a half by AdjustBundle, which says why.
BundleOptions HalfOptions(BundleOptions options) {
  options.reject = false;
  return options;
}

// Which grid points lie within the convex hull of the corners.
std::vector<bool> WithinHull(const std::vector<Eigen::Vector2d>& corners, const ImageGrid& grid) {
  std::vector<cv::Point2f> points, hull;
  for (const Eigen::Vector2d& c : corners) {
    points.emplace_back(static_cast<float>(c.x()), static_cast<float>(c.y()));
  }
  cv::convexHull(points, hull);
  std::vector<bool> within;
  for (const Eigen::Vector2d& p : grid.points_px) {
    const cv::Point2f at(static_cast<float>(p.x()), static_cast<float>(p.y()));
    within.push_back(cv::pointPolygonTest(hull, at, false) >= 0);
  }
  return within;
}

CameraDifference Compare(const BundleResult& all, const BundleResult& odd, const BundleResult& even,
                         int camera) {
  CameraDifference out;
  out.camera = camera;
  const Camera& of = all.cameras[camera].camera;
  const Camera &from = odd.cameras[camera].camera, &to = even.cameras[camera].camera;
  const auto points = SeenPoints(all, camera);
  const Rigid3 to_from_from = AlignCameras(from, to, points);
  const ProjectionUncertainty odd_uncertainty(odd.cameras[camera], points);
  const ProjectionUncertainty even_uncertainty(even.cameras[camera], points);
  const double depth_mm = odd_uncertainty.median_depth_mm();
  out.grid = GridOver(of);
  out.seen = WithinHull(SeenCorners(all, camera), out.grid);
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  double squares = 0, variance = 0;
  int places = 0;
  for (size_t i = 0; i < out.grid.points_px.size(); ++i) {
    const Eigen::Vector2d& at = out.grid.points_px[i];
    const auto point = PointSeenAt(from, at, depth_mm);
    if (!point || !((to_from_from * *point).z() > 1e-9)) {
      out.difference_px.emplace_back(kNone, kNone);
      continue;
    }
    out.difference_px.push_back(ImageFromCamera(to, to_from_from * *point) - at);
    if (!out.seen[i]) continue;
    squares += out.difference_px.back().squaredNorm();
    variance += (odd_uncertainty.At(*point) + even_uncertainty.At(*point)).trace();
    ++places;
  }
  out.rms_px = std::sqrt(squares / std::max(1, places));
  out.predicted_px = std::sqrt(variance / std::max(1, places));
  return out;
}

// Residuals of one half's photos under the other's intrinsics (and bend).
void HoldOut(BundleProblem photos, const BundleResult& intrinsics, BundleOptions options,
             CrossValidation* out) {
  for (size_t c = 0; c < photos.cameras.size(); ++c) {
    photos.cameras[c].known = intrinsics.cameras[c].camera;
  }
  photos.bend = intrinsics.bend;
  options.bend = false;
  const BundleResult result = AdjustBundle(photos, options);
  for (size_t i = 0; i < result.photos.size(); ++i) {
    if (!result.photos[i].rejected.empty()) continue;
    out->held_out_px2[i] = result.photos[i].rms_px * result.photos[i].rms_px;
  }
}

void SumHeldOut(const BundleResult& all, CrossValidation* out) {
  double sum = 0;
  int corners = 0;
  for (size_t i = 0; i < out->held_out_px2.size(); ++i) {
    if (std::isnan(out->held_out_px2[i])) continue;
    sum += out->held_out_px2[i] * all.photos[i].inliers();
    corners += all.photos[i].inliers();
  }
  out->held_out_rms_px = std::sqrt(sum / std::max(1, corners));
}

std::string TooFew(const BundleProblem& problem, const BundleResult& result) {
  bool any = false;
  for (size_t c = 0; c < problem.cameras.size(); ++c) {
    if (problem.cameras[c].known || result.cameras[c].photos == 0) continue;
    any = true;
    if (result.cameras[c].photos >= kLeastPhotos) continue;
    return fmt::format("{} photograph{} of camera {}; {} are needed", result.cameras[c].photos,
                       result.cameras[c].photos == 1 ? "" : "s", c, kLeastPhotos);
  }
  return any ? "" : "the intrinsics are given";
}

}  // namespace

double CrossValidation::ratio() const {
  double largest = 0;
  for (const CameraDifference& camera : cameras) largest = std::max(largest, camera.ratio());
  return largest;
}

bool CrossValidation::trusted() const {
  return std::all_of(cameras.begin(), cameras.end(),
                     [](const CameraDifference& camera) { return camera.trusted(); });
}

BundleProblem Accepted(const BundleProblem& problem, const BundleResult& result, int parity) {
  BundleProblem out = problem;
  std::vector<int> count(problem.cameras.size(), 0);
  for (size_t i = 0; i < problem.photos.size(); ++i) {
    BundlePhoto& photo = out.photos[i];
    photo.corners.clear();
    if (!result.photos[i].rejected.empty()) continue;
    if (parity >= 0 && count[photo.camera]++ % 2 != parity) continue;
    for (size_t k = 0; k < problem.photos[i].corners.size(); ++k) {
      if (result.photos[i].corners[k].inlier) photo.corners.push_back(problem.photos[i].corners[k]);
    }
  }
  return out;
}

CrossValidation CrossValidate(const BundleProblem& problem, const BundleOptions& options,
                              const BundleResult& result) {
  CrossValidation out;
  out.held_out_px2.assign(result.photos.size(), std::numeric_limits<double>::quiet_NaN());
  out.problem = TooFew(problem, result);
  if (!out.problem.empty()) return out;
  const BundleOptions half = HalfOptions(options);
  const BundleProblem odd_photos = Accepted(problem, result, 0);
  const BundleProblem even_photos = Accepted(problem, result, 1);
  try {
    const BundleResult odd = AdjustBundle(odd_photos, half);
    const BundleResult even = AdjustBundle(even_photos, half);
    for (size_t c = 0; c < problem.cameras.size(); ++c) {
      if (problem.cameras[c].known || result.cameras[c].photos == 0) continue;
      out.cameras.push_back(Compare(result, odd, even, static_cast<int>(c)));
    }
    HoldOut(even_photos, odd, half, &out);
    HoldOut(odd_photos, even, half, &out);
  } catch (const UserError&) {
    out.cameras.clear();
    out.problem =
        "half of the photographs leaves the focal length undetermined; take more tilted "
        "ones";
    return out;
  } catch (const ComputationError& error) {
    out.cameras.clear();
    out.problem = std::string("half of the photographs gives no calibration: ") + error.what();
    return out;
  }
  SumHeldOut(result, &out);
  return out;
}

}  // namespace glint
