#include "calib/uncertainty/projection_jacobian.h"

#include <ceres/jet.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace glint {

Eigen::Matrix<double, 2, 6> ByMotion(const Eigen::Matrix<double, 2, 3>& by_point,
                                     const Eigen::Vector3d& turned) {
  Eigen::Matrix3d cross;  // w × p = −[p]× w
  cross << 0, -turned.z(), turned.y(), turned.z(), 0, -turned.x(), -turned.y(), turned.x(), 0;
  Eigen::Matrix<double, 2, 6> j;
  j << -by_point * cross, by_point;
  return j;
}

ProjectionJacobian Differentiate(const Camera& camera, const Eigen::Vector3d& point_in_camera) {
  constexpr int kMost = 12;  // parameters of a model
  using Jet = ceres::Jet<double, kMost + 3>;
  const int n = static_cast<int>(camera.parameters.size());
  std::array<Jet, kMost> parameters;
  for (int i = 0; i < n; ++i) parameters[i] = Jet(camera.parameters[i], i);
  Jet p[3];
  for (int i = 0; i < 3; ++i) p[i] = Jet(point_in_camera[i], kMost + i);
  Jet x, y;
  ImageFromNormalized(camera.model, parameters.data(), Jet(p[0] / p[2]), Jet(p[1] / p[2]), &x, &y);
  ProjectionJacobian out;
  out.point_px = {x.a, y.a};
  out.by_parameters.resize(2, n);
  out.by_parameters << x.v.head(n).transpose(), y.v.head(n).transpose();
  out.by_point << x.v.tail<3>().transpose(), y.v.tail<3>().transpose();
  return out;
}

std::optional<Eigen::Vector3d> PointSeenAt(const Camera& camera, const Eigen::Vector2d& point_px,
                                           double depth_mm) {
  const auto uv = NormalizedFromImage(camera, point_px);
  if (!uv) return std::nullopt;
  return Eigen::Vector3d(depth_mm * uv->x(), depth_mm * uv->y(), depth_mm);
}

double WorstSigma(const Eigen::Matrix2d& covariance) {
  const double mean = 0.5 * covariance.trace();
  const double half = 0.5 * (covariance(0, 0) - covariance(1, 1));
  return std::sqrt(std::max(0.0, mean + std::hypot(half, covariance(0, 1))));
}

}  // namespace glint
