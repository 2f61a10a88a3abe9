#include "calib/uncertainty/implied_motion.h"

#include <Eigen/Cholesky>
#include <Eigen/Geometry>

#include "calib/uncertainty/projection_jacobian.h"

namespace glint {
namespace {

using Matrix6 = Eigen::Matrix<double, 6, 6>;
using Vector6 = Eigen::Matrix<double, 6, 1>;

Rigid3 MotionOf(const Vector6& motion) {
  const Eigen::Vector3d w = motion.head<3>();
  const double angle = w.norm();
  Rigid3 rigid;
  if (angle > 0) rigid.rotation = Eigen::AngleAxisd(angle, w / angle).toRotationMatrix();
  rigid.translation = motion.tail<3>();
  return rigid;
}

}  // namespace

std::vector<Eigen::Vector3d> SeenPoints(const BundleResult& result, int camera) {
  std::vector<Eigen::Vector3d> points;
  for (const PhotoEstimate& photo : result.photos) {
    if (photo.camera != camera || !photo.rejected.empty()) continue;
    for (const CornerResidual& corner : photo.corners) {
      if (!corner.inlier) continue;
      points.push_back(photo.camera_from_sample *
                       BoardPoint(result.bend, corner.position_in_sample_mm));
    }
  }
  return points;
}

Eigen::MatrixXd ImpliedMotion(const Camera& camera, const std::vector<Eigen::Vector3d>& points) {
  const long n = static_cast<long>(camera.parameters.size());
  Matrix6 normal = Matrix6::Zero();
  Eigen::MatrixXd right = Eigen::MatrixXd::Zero(6, n);
  for (const Eigen::Vector3d& point : points) {
    const ProjectionJacobian j = Differentiate(camera, point);
    const Eigen::Matrix<double, 2, 6> by_motion = ByMotion(j.by_point, point);
    normal += by_motion.transpose() * by_motion;
    right += by_motion.transpose() * j.by_parameters;
  }
  return -normal.ldlt().solve(right);
}

Rigid3 AlignCameras(const Camera& from, const Camera& to,
                    const std::vector<Eigen::Vector3d>& points_in_from) {
  constexpr int kIterations = 20;
  Rigid3 to_from_from;
  for (int i = 0; i < kIterations; ++i) {
    Matrix6 normal = Matrix6::Zero();
    Vector6 right = Vector6::Zero();
    for (const Eigen::Vector3d& point : points_in_from) {
      const Eigen::Vector3d moved = to_from_from * point;
      if (!(moved.z() > 1e-9)) continue;
      const ProjectionJacobian j = Differentiate(to, moved);
      const Eigen::Matrix<double, 2, 6> by_motion = ByMotion(j.by_point, moved);
      normal += by_motion.transpose() * by_motion;
      right += by_motion.transpose() * (ImageFromCamera(from, point) - j.point_px);
    }
    const Vector6 step = normal.ldlt().solve(right);
    if (!step.allFinite()) break;
    to_from_from = MotionOf(step) * to_from_from;
    if (step.head<3>().norm() < 1e-12 && step.tail<3>().norm() < 1e-9) break;
  }
  return to_from_from;
}

}  // namespace glint
