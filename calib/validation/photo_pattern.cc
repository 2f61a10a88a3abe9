#include "calib/validation/photo_pattern.h"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "calib/uncertainty/projection_jacobian.h"

namespace glint {
namespace {

constexpr int kLeastCorners = 12;

struct Residuals {
  Eigen::VectorXd values;       // x, y of each inlier
  Eigen::MatrixXd pose;         // their derivatives by the pose
  Eigen::VectorXd row, column;  // from −0.5 to 0.5 over the image, twice per inlier
};

Residuals Collect(const BundleResult& result, const PhotoEstimate& photo) {
  const Camera& camera = result.cameras[photo.camera].camera;
  const long n = photo.inliers();
  Residuals out{Eigen::VectorXd(2 * n), Eigen::MatrixXd(2 * n, 6), Eigen::VectorXd(2 * n),
                Eigen::VectorXd(2 * n)};
  long at = 0;
  for (const CornerResidual& corner : photo.corners) {
    if (!corner.inlier) continue;
    const Eigen::Vector3d point =
        photo.camera_from_sample * BoardPoint(result.bend, corner.position_in_sample_mm);
    out.values.segment<2>(at) = corner.residual_px;
    out.pose.middleRows<2>(at) = ByMotion(Differentiate(camera, point).by_point,
                                          point - photo.camera_from_sample.translation);
    out.row.segment<2>(at).setConstant(corner.point_px.y() / camera.height_px - 0.5);
    out.column.segment<2>(at).setConstant(corner.point_px.x() / camera.width_px - 0.5);
    at += 2;
  }
  return out;
}

struct MotionFit {
  double share = 0, f = 0;
  double effect_px = 0;
  Eigen::MatrixXd fitted;  // one column
};

// What a change of the pose along `ramp` explains beyond the pose itself.
MotionFit FitMotion(const Residuals& residuals, const Eigen::VectorXd& ramp) {
  const Eigen::HouseholderQR<Eigen::MatrixXd> pose(residuals.pose);
  const auto beyond_pose = [&](const Eigen::MatrixXd& m) -> Eigen::MatrixXd {
    return m - residuals.pose * pose.solve(m);
  };
  const Eigen::MatrixXd motion = beyond_pose(ramp.asDiagonal() * residuals.pose);
  const Eigen::MatrixXd values = beyond_pose(residuals.values);
  MotionFit fit;
  // Rank-revealing: a board whose corners lie in a few rows leaves some motions undetermined.
  fit.fitted = motion * Eigen::ColPivHouseholderQR<Eigen::MatrixXd>(motion).solve(values);
  const double before = values.squaredNorm(), after = (values - fit.fitted).squaredNorm();
  const double freedom = std::max<double>(1, static_cast<double>(values.size()) - 12);
  fit.share = before > 0 ? (before - after) / before : 0;
  fit.f = after > 0 ? (before - after) / 6 / (after / freedom) : 0;
  fit.effect_px = std::sqrt(2 * fit.fitted.squaredNorm() / static_cast<double>(values.size()));
  return fit;
}

void Axes(const Eigen::MatrixXd& values, PhotoPattern* out) {
  const Eigen::Map<const Eigen::Matrix2Xd> points(values.data(), 2, values.size() / 2);
  const Eigen::Matrix2d moment = points * points.transpose() / static_cast<double>(points.cols());
  const double along = WorstSigma(moment);
  out->mean_length_px = along;
  out->across_px = std::sqrt(std::max(0.0, moment.trace() - along * along));
  const double angle = 0.5 * std::atan2(2 * moment(0, 1), moment(0, 0) - moment(1, 1));
  out->axis_deg = std::fmod(angle * 180 / std::numbers::pi + 180, 180);
}

}  // namespace

PhotoPattern PatternOf(const BundleResult& result, size_t photo, double usual_length_px) {
  constexpr double kLeastF = 8;  // for 100 residuals by chance once in ten million
  constexpr double kLeastShare = 0.3;
  constexpr double kLeastEffect_px = 0.1;
  constexpr double kLineRatio = 2, kAboveUsual = 1.5;
  PhotoPattern out;
  const PhotoEstimate& estimate = result.photos[photo];
  out.rms_px = estimate.rms_px;
  if (estimate.inliers() < kLeastCorners) return out;
  const Residuals residuals = Collect(result, estimate);
  const MotionFit rows = FitMotion(residuals, residuals.row);
  const MotionFit columns = FitMotion(residuals, residuals.column);
  out.row_motion_px = rows.effect_px;
  out.row_motion_share = rows.share;
  out.row_motion_f = rows.f;
  out.column_motion_share = columns.share;
  // A motion along columns must not explain clearly more. It often explains as much: a board seen
  // from the front is sheared by both alike.
  out.moved_while_read = rows.f > kLeastF && rows.share > kLeastShare &&
                         rows.effect_px > kLeastEffect_px &&
                         1 - rows.share < 1.1 * (1 - columns.share);
  Eigen::MatrixXd rest = residuals.values;
  if (out.moved_while_read) rest -= rows.fitted;
  Axes(rest, &out);
  out.scattered_on_a_line = usual_length_px > 0 &&
                            out.mean_length_px > kLineRatio * out.across_px &&
                            out.mean_length_px > kAboveUsual * usual_length_px;
  return out;
}

}  // namespace glint
