// Rigid motions with the frames in the name: p_in_b = b_from_a * p_in_a.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace glint {

struct Rigid3 {
  Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();
  Eigen::Vector3d translation = Eigen::Vector3d::Zero();
};

inline Eigen::Vector3d operator*(const Rigid3& b_from_a, const Eigen::Vector3d& point_in_a) {
  return b_from_a.rotation * point_in_a + b_from_a.translation;
}

inline Rigid3 operator*(const Rigid3& c_from_b, const Rigid3& b_from_a) {
  return {c_from_b.rotation * b_from_a.rotation,
          c_from_b.rotation * b_from_a.translation + c_from_b.translation};
}

inline Rigid3 Inverse(const Rigid3& b_from_a) {
  const Eigen::Matrix3d rotation = b_from_a.rotation.transpose();
  return {rotation, -(rotation * b_from_a.translation)};
}

}  // namespace glint
