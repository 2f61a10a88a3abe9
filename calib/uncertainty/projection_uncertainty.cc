#include "calib/uncertainty/projection_uncertainty.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/statistics/median.h"
#include "calib/uncertainty/implied_motion.h"
#include "calib/uncertainty/projection_jacobian.h"

namespace glint {
namespace {}  // namespace

ProjectionUncertainty::ProjectionUncertainty(const CameraEstimate& estimate,
                                             const std::vector<Eigen::Vector3d>& points_in_camera)
    : estimate_(estimate), motion_(ImpliedMotion(estimate.camera, points_in_camera)) {
  std::vector<double> depths;
  depths.reserve(points_in_camera.size());
  for (const Eigen::Vector3d& point : points_in_camera) depths.push_back(point.z());
  median_depth_mm_ = Median(std::move(depths));
}

Eigen::Matrix2d ProjectionUncertainty::At(const Eigen::Vector3d& point_in_camera) const {
  const ProjectionJacobian j = Differentiate(estimate_.camera, point_in_camera);
  const Eigen::MatrixXd total = j.by_parameters + ByMotion(j.by_point, point_in_camera) * motion_;
  return total * estimate_.covariance * total.transpose();
}

std::optional<Eigen::Matrix2d> ProjectionUncertainty::At(const Eigen::Vector2d& point_px,
                                                         double depth_mm) const {
  const auto point = PointSeenAt(estimate_.camera, point_px, depth_mm);
  if (!point) return std::nullopt;
  return At(*point);
}

ImageGrid GridOver(const Camera& camera, int columns) {
  const double cell = static_cast<double>(std::max(camera.width_px, camera.height_px)) / columns;
  ImageGrid grid;
  grid.columns = std::max(1, static_cast<int>(std::lround(camera.width_px / cell)));
  grid.rows = std::max(1, static_cast<int>(std::lround(camera.height_px / cell)));
  for (int j = 0; j < grid.rows; ++j) {
    for (int i = 0; i < grid.columns; ++i) {
      grid.points_px.emplace_back((i + 0.5) * camera.width_px / grid.columns,
                                  (j + 0.5) * camera.height_px / grid.rows);
    }
  }
  return grid;
}

UncertaintyMap MapUncertainty(const BundleResult& result, int camera) {
  const CameraEstimate& estimate = result.cameras[camera];
  const ProjectionUncertainty uncertainty(estimate, SeenPoints(result, camera));
  UncertaintyMap map;
  map.grid = GridOver(estimate.camera);
  map.depth_mm = uncertainty.median_depth_mm();
  const auto sigma_at = [&](const Eigen::Vector2d& point_px) {
    const auto covariance = uncertainty.At(point_px, map.depth_mm);
    return covariance ? WorstSigma(*covariance) : std::numeric_limits<double>::quiet_NaN();
  };
  std::vector<double> known;
  for (const Eigen::Vector2d& point_px : map.grid.points_px) {
    map.sigma_px.push_back(sigma_at(point_px));
    if (std::isfinite(map.sigma_px.back())) known.push_back(map.sigma_px.back());
  }
  map.centre_px = sigma_at({0.5 * estimate.camera.width_px, 0.5 * estimate.camera.height_px});
  if (!known.empty()) map.largest_px = *std::max_element(known.begin(), known.end());
  map.median_px = Median(std::move(known));
  return map;
}

}  // namespace glint
