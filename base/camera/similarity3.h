// Similarities with the frames in the name: p_in_b = b_from_a * p_in_a = scale · R · p + t.
#pragma once

#include <Eigen/Geometry>
#include <Eigen/SVD>
#include <cmath>
#include <optional>

#include "base/camera/rigid3.h"

namespace glint {

struct Similarity3 {
  double scale = 1;
  Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();
  Eigen::Vector3d translation = Eigen::Vector3d::Zero();
};

inline Eigen::Vector3d operator*(const Similarity3& b_from_a, const Eigen::Vector3d& point_in_a) {
  return b_from_a.scale * (b_from_a.rotation * point_in_a) + b_from_a.translation;
}

inline Similarity3 Inverse(const Similarity3& b_from_a) {
  const Eigen::Matrix3d rotation = b_from_a.rotation.transpose();
  return {1 / b_from_a.scale, rotation, -(rotation * b_from_a.translation) / b_from_a.scale};
}

// A camera's pose after its world went through b_from_a. The camera frame takes the scale of b, so
// that the picture of every point stays where it is.
inline Rigid3 MovedPose(const Rigid3& camera_from_a, const Similarity3& b_from_a) {
  const Eigen::Matrix3d rotation = camera_from_a.rotation * b_from_a.rotation.transpose();
  return {rotation, b_from_a.scale * camera_from_a.translation - rotation * b_from_a.translation};
}

// The similarity of least squares that takes the columns of `a` to those of `b` (Umeyama, PAMI 13,
// 1991). nullopt for fewer than three points, or points on a line.
inline std::optional<Similarity3> AlignPoints(const Eigen::Matrix3Xd& a,
                                              const Eigen::Matrix3Xd& b) {
  if (a.cols() < 3 || a.cols() != b.cols()) return std::nullopt;
  for (const auto* points : {&a, &b}) {
    const Eigen::Matrix3Xd centred = points->colwise() - points->rowwise().mean();
    const Eigen::Vector3d spread = Eigen::JacobiSVD<Eigen::MatrixXd>(centred).singularValues();
    if (!(spread[1] > 1e-6 * spread[0])) return std::nullopt;
  }
  const Eigen::Matrix4d matrix = Eigen::umeyama(a, b, true);
  Similarity3 b_from_a;
  b_from_a.scale = std::cbrt(matrix.topLeftCorner<3, 3>().determinant());
  b_from_a.rotation = matrix.topLeftCorner<3, 3>() / b_from_a.scale;
  b_from_a.translation = matrix.topRightCorner<3, 1>();
  return b_from_a;
}

}  // namespace glint
