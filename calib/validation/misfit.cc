#include "calib/validation/misfit.h"

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>

#include "base/errors/errors.h"
#include "calib/uncertainty/projection_jacobian.h"

namespace glint {
namespace {

// A change of the pose in the camera's frame (rotation vector, shift in mm), ln zoom, shift in px.
constexpr int kPose = 6, kAll = 9;
using Change = Eigen::Matrix<double, kAll, 1>;

Eigen::VectorXd ResidualsOf(const Camera& camera, const PhotoEstimate& photo,
                            const std::optional<BoardBend>& bend, const Change& change) {
  const Eigen::Vector3d turn = change.head<3>();
  const double angle = turn.norm();
  Rigid3 moved;
  if (angle > 0) moved.rotation = Eigen::AngleAxisd(angle, turn / angle).toRotationMatrix();
  moved.translation = change.segment<3>(3);
  const Rigid3 pose = moved * photo.camera_from_sample;
  const Eigen::Vector2d middle(camera.width_px / 2.0, camera.height_px / 2.0);
  const double zoom = std::exp(change[kPose]);
  Eigen::VectorXd residuals(2 * static_cast<Eigen::Index>(photo.corners.size()));
  for (size_t i = 0; i < photo.corners.size(); ++i) {
    const CornerResidual& corner = photo.corners[i];
    const Eigen::Vector3d point = pose * BoardPoint(bend, corner.position_in_sample_mm);
    const Eigen::Vector2d seen = ImageFromCamera(camera, point);
    const Eigen::Vector2d at = middle + zoom * (seen - middle) + change.tail<2>();
    residuals.segment<2>(2 * static_cast<Eigen::Index>(i)) = corner.point_px - at;
  }
  return residuals;
}

double RootMeanSquare(const Eigen::VectorXd& residuals) {
  return std::sqrt(2 * residuals.squaredNorm() / static_cast<double>(residuals.size()));
}

// Levenberg and Marquardt over what is free.
Change FitChange(const Camera& camera, const PhotoEstimate& photo,
                 const std::optional<BoardBend>& bend, const std::array<bool, kAll>& free) {
  constexpr int kSteps = 60;
  constexpr std::array<double, kAll> kStep = {1e-6, 1e-6, 1e-6, 1e-4, 1e-4, 1e-4, 1e-6, 1e-3, 1e-3};
  Change best = Change::Zero();
  Eigen::VectorXd residuals = ResidualsOf(camera, photo, bend, best);
  double damping = 1e-3;
  for (int step = 0; step < kSteps && damping < 1e9; ++step) {
    Eigen::MatrixXd jacobian = Eigen::MatrixXd::Zero(residuals.size(), kAll);
    for (int k = 0; k < kAll; ++k) {
      if (!free[static_cast<size_t>(k)]) continue;
      Change there = best;
      there[k] += kStep[static_cast<size_t>(k)];
      jacobian.col(k) =
          (ResidualsOf(camera, photo, bend, there) - residuals) / kStep[static_cast<size_t>(k)];
    }
    Eigen::Matrix<double, kAll, kAll> normal = jacobian.transpose() * jacobian;
    normal.diagonal() += damping * normal.diagonal() + Change::Constant(1e-12);
    const Change delta = -normal.ldlt().solve(jacobian.transpose() * residuals);
    const Change trial = best + delta;
    if (!trial.allFinite() || std::abs(trial[kPose]) > 3) break;
    const Eigen::VectorXd after = ResidualsOf(camera, photo, bend, trial);
    if (!(after.squaredNorm() < residuals.squaredNorm())) {
      damping *= 8;
      continue;
    }
    const bool settled = after.squaredNorm() > 0.9999 * residuals.squaredNorm();
    best = trial;
    residuals = after;
    damping = std::max(1e-9, damping / 5);
    if (settled) break;
  }
  return best;
}

std::array<bool, kAll> Free(bool zoom, bool shift) {
  return {true, true, true, true, true, true, zoom, shift, shift};
}

// RMS of all corners with the board's height changed; infinite where that cannot be solved.
double StretchedRms(const BundleProblem& problem, BundleOptions options, double relative) {
  BundleProblem stretched = problem;
  for (BundlePhoto& photo : stretched.photos) {
    for (BundleCorner& corner : photo.corners) corner.position_in_sample_mm.y() *= 1 + relative;
  }
  options.model = CameraModel::kRadial;
  options.hold.clear();
  options.bend = false;
  options.reject = false;
  try {
    return AdjustBundle(stretched, options).rms_px;
  } catch (const Error&) {
    return INFINITY;
  }
}

// How far the solution's residuals still pull at the board's height, in standard deviations, at
// least: what cameras and poses would give way is not counted.
double PullAtStretch(const BundleResult& result) {
  double gradient = 0, curvature = 0;
  for (const PhotoEstimate& photo : result.photos) {
    if (!photo.rejected.empty()) continue;
    const Camera& camera = result.cameras[static_cast<size_t>(photo.camera)].camera;
    for (const CornerResidual& corner : photo.corners) {
      if (!corner.inlier) continue;
      const Eigen::Vector3d point =
          photo.camera_from_sample * BoardPoint(result.bend, corner.position_in_sample_mm);
      const Eigen::Vector2d slope = Differentiate(camera, point).by_point *
                                    photo.camera_from_sample.rotation.col(1) *
                                    corner.position_in_sample_mm.y();
      gradient += slope.dot(corner.residual_px);
      curvature += slope.squaredNorm();
    }
  }
  const double sigma = result.sigma_px * std::sqrt(curvature);
  return sigma > 0 ? std::abs(gradient) / sigma : 0;
}

bool HintsAtStretch(const BundleResult& result) {
  constexpr double kOddPixels = 0.002, kSigmas = 5;
  if (PullAtStretch(result) > kSigmas) return true;
  for (const CameraEstimate& estimate : result.cameras) {
    const Camera& camera = estimate.camera;
    if (estimate.photos == 0 || estimate.sigma.size() < 2) continue;
    const double odd = std::abs(camera.focal_length_y() / camera.focal_length_x() - 1);
    const double sigma = estimate.sigma[1] / camera.focal_length_y();
    if (odd > std::max(kOddPixels, kSigmas * sigma)) return true;
  }
  return std::any_of(result.photos.begin(), result.photos.end(), [](const PhotoEstimate& photo) {
    return !photo.rejected.empty() && !photo.corners.empty();
  });
}

}  // namespace

std::optional<OtherView> ExplainByOtherView(const BundleResult& result,
                                            const PhotoEstimate& photo) {
  constexpr size_t kLeastCorners = 12;
  constexpr double kExplained = 0.3, kGood_px = 0.5, kUsual = 5;
  constexpr double kLeastZoom = 0.005, kLeastShift = 0.005;  // of the longer side
  if (photo.corners.size() < kLeastCorners) return std::nullopt;
  const Camera& camera = result.cameras[static_cast<size_t>(photo.camera)].camera;
  const auto fit = [&](bool zoom, bool shift) {
    const Change change = FitChange(camera, photo, result.bend, Free(zoom, shift));
    OtherView view;
    view.zoom = std::exp(change[kPose]);
    view.shift_px = change.tail<2>();
    view.after_px = RootMeanSquare(ResidualsOf(camera, photo, result.bend, change));
    return view;
  };
  const double before_px = fit(false, false).after_px;
  const double side = std::max(camera.width_px, camera.height_px);
  // From the simplest on.
  for (const auto& [zoom, shift] : {std::pair{true, false}, {false, true}, {true, true}}) {
    OtherView view = fit(zoom, shift);
    view.before_px = before_px;
    const bool explained = view.after_px < kExplained * before_px &&
                           view.after_px < std::max(kGood_px, kUsual * result.rms_px);
    const bool worth_a_word =
        std::abs(std::log(view.zoom)) > kLeastZoom || view.shift_px.norm() > kLeastShift * side;
    if (explained && worth_a_word) return view;
  }
  return std::nullopt;
}

std::string InWords(const OtherView& view) {
  const bool zoomed = view.zoom != 1, shifted = !view.shift_px.isZero();
  std::string text = "as if ";
  if (zoomed) text += fmt::format("taken with {:.3g} times the others' focal length", view.zoom);
  if (shifted) {
    text += fmt::format("{}cropped with its centre {:.0f} px off", zoomed ? ", and " : "",
                        view.shift_px.norm());
  }
  return text + fmt::format(" (the residual falls from {:.2f} to {:.2f} px): {}", view.before_px,
                            view.after_px,
                            shifted
                                ? "it was cropped or stabilised; use the camera's own file"
                                : "zoom, another lens or another focus; lock zoom, lens and focus");
}

BoardStretch FindBoardStretch(const BundleProblem& problem, const BundleOptions& options,
                              const BundleResult& result) {
  constexpr double kTrial = 0.01, kLeast = 0.002, kMost = 0.1, kExplained = 0.5;
  for (const BundleCamera& camera : problem.cameras) {
    if (camera.known) return {};
  }
  if (!HintsAtStretch(result)) return {};
  const double none = StretchedRms(problem, options, 0);
  const double less = StretchedRms(problem, options, -kTrial);
  const double more = StretchedRms(problem, options, kTrial);
  if (!std::isfinite(none) || !std::isfinite(less) || !std::isfinite(more)) return {};
  // The squares of residuals are a parabola of the stretch.
  const double curvature = less * less - 2 * none * none + more * more;
  if (curvature <= 0) return {};
  const double relative = kTrial / 2 * (less * less - more * more) / curvature;
  if (std::abs(relative) < kLeast || std::abs(relative) > kMost) return {};
  const double with = StretchedRms(problem, options, relative);
  if (!(with < kExplained * none)) return {};
  return {relative, none, with};
}

std::string InWords(const BoardStretch& stretch) {
  return fmt::format(
      "the board's squares seem to be {:.1f} % {} than wide (with that the residual falls from "
      "{:.2f} to {:.2f} px): the printer or \"fit to page\" stretched it, or the photographs were "
      "squeezed. Measure the board both ways, and print it at 100 % on a printer that scales both "
      "directions equally",
      100 * std::abs(stretch.relative), stretch.relative > 0 ? "higher" : "lower",
      stretch.before_px, stretch.after_px);
}

}  // namespace glint
