#include "calib/guidance/coverage.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace glint {
namespace {

double AngleToNormal_deg(const Eigen::Vector3d& v) {
  return std::atan2(std::hypot(v.x(), v.y()), v.z()) / kDegree;
}

Eigen::Vector3d OnPlane(const Eigen::Vector2d& point_mm) { return {point_mm.x(), point_mm.y(), 0}; }

}  // namespace

Eigen::Vector2d CoverageGrid::Centre_mm(size_t cell) const {
  const double column = static_cast<double>(cell % static_cast<size_t>(columns));
  const double row = static_cast<double>(cell / static_cast<size_t>(columns));
  return {((column + 0.5) / columns - 0.5) * width_mm, (0.5 - (row + 0.5) / rows) * height_mm};
}

CoverageGrid MakeCoverageGrid(const std::array<double, 2>& sample_size_mm, int most) {
  const double longer = std::max(sample_size_mm[0], sample_size_mm[1]);
  const auto cells = [&](double side) {
    return std::max(1, static_cast<int>(std::lround(most * side / longer)));
  };
  return {cells(sample_size_mm[0]), cells(sample_size_mm[1]), sample_size_mm[0], sample_size_mm[1]};
}

double Coverage::ShownShare() const {
  const auto shown = std::count_if(photos.begin(), photos.end(), [](int n) { return n > 0; });
  return static_cast<double>(shown) / static_cast<double>(grid.cells());
}

double Coverage::HighlightShare(double highlight_deg) const {
  const auto near = std::count_if(least_half_angle_deg.begin(), least_half_angle_deg.end(),
                                  [&](double angle) { return angle <= highlight_deg; });
  return static_cast<double>(near) / static_cast<double>(grid.cells());
}

Coverage ComputeCoverage(const CoverageGrid& grid, const std::vector<GuidancePhoto>& photos) {
  Coverage coverage{grid, std::vector<int>(grid.cells(), 0),
                    std::vector<double>(grid.cells(), std::numeric_limits<double>::infinity())};
  for (const GuidancePhoto& photo : photos) {
    for (size_t cell = 0; cell < grid.cells(); ++cell) {
      const Eigen::Vector2d at = grid.Centre_mm(cell);
      if (!ShowsPoint(photo, at)) continue;
      ++coverage.photos[cell];
      double& least = coverage.least_half_angle_deg[cell];
      least =
          std::min(least, HalfAngle_deg(photo.camera_in_sample_mm, photo.light_in_sample_mm, at));
    }
  }
  return coverage;
}

double HalfAngle_deg(const Eigen::Vector3d& camera_mm, const Eigen::Vector3d& light_mm,
                     const Eigen::Vector2d& point_mm) {
  const Eigen::Vector3d v = camera_mm - OnPlane(point_mm), l = light_mm - OnPlane(point_mm);
  if (!(v.z() > 0 && l.z() > 0)) return 180;
  return AngleToNormal_deg(v.normalized() + l.normalized());
}

bool ShowsPoint(const GuidancePhoto& photo, const Eigen::Vector2d& point_mm) {
  if (!photo.posed) return photo.camera_in_sample_mm.z() > 0;
  const Camera& camera = photo.posed->camera;
  const Eigen::Vector3d at = photo.posed->camera_from_sample * OnPlane(point_mm);
  if (at.z() <= 0) return false;
  // Far outside of the picture a polynomial distortion folds back into it.
  const double half_diagonal_px = 0.5 * std::hypot(camera.width_px, camera.height_px);
  const double focal_px = std::min(camera.focal_length_x(), camera.focal_length_y());
  if (std::hypot(at.x(), at.y()) * focal_px > 1.3 * half_diagonal_px * at.z()) return false;
  const Eigen::Vector2d px = ImageFromCamera(camera, at);
  return px.x() >= 0 && px.y() >= 0 && px.x() <= camera.width_px && px.y() <= camera.height_px;
}

double ShownShare(const GuidancePhoto& photo, const CoverageGrid& grid) {
  size_t shown = 0;
  for (size_t cell = 0; cell < grid.cells(); ++cell) {
    if (ShowsPoint(photo, grid.Centre_mm(cell))) ++shown;
  }
  return static_cast<double>(shown) / static_cast<double>(grid.cells());
}

double PixelsPerMm(const GuidancePhoto& photo) {
  if (!photo.posed || !ShowsPoint(photo, {0, 0})) return 0;
  constexpr double kStep_mm = 0.01;
  const auto image = [&](double x_mm, double y_mm) {
    return ImageFromCamera(photo.posed->camera,
                           photo.posed->camera_from_sample * Eigen::Vector3d(x_mm, y_mm, 0));
  };
  Eigen::Matrix2d px_per_mm;
  px_per_mm.col(0) = (image(kStep_mm, 0) - image(-kStep_mm, 0)) / (2 * kStep_mm);
  px_per_mm.col(1) = (image(0, kStep_mm) - image(0, -kStep_mm)) / (2 * kStep_mm);
  const double area = px_per_mm(0, 0) * px_per_mm(1, 1) - px_per_mm(0, 1) * px_per_mm(1, 0);
  return std::sqrt(std::abs(area));
}

Direction DirectionOf(const Eigen::Vector3d& point_in_sample_mm) {
  double azimuth = std::atan2(point_in_sample_mm.y(), point_in_sample_mm.x()) / kDegree;
  if (azimuth < 0) azimuth += 360;
  return {AngleToNormal_deg(point_in_sample_mm), azimuth};
}

}  // namespace glint
