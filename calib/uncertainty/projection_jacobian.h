// How an image point moves with the camera's parameters and with the point it is the image of.
#pragma once

#include <Eigen/Core>

#include "base/camera/camera_model.h"

namespace glint {

struct ProjectionJacobian {
  Eigen::Vector2d point_px;
  Eigen::MatrixXd by_parameters;         // 2 × parameters of the model
  Eigen::Matrix<double, 2, 3> by_point;  // px / mm
};

// By a small rotation vector w and a shift t of the point: it moves by w × turned + t. `turned` is
// the part of the point that the rotation acts on.
Eigen::Matrix<double, 2, 6> ByMotion(const Eigen::Matrix<double, 2, 3>& by_point,
                                     const Eigen::Vector3d& turned);

// The point lies in front of the camera (z > 0).
ProjectionJacobian Differentiate(const Camera& camera, const Eigen::Vector3d& point_in_camera);

// The point at depth `depth_mm` (along the optical axis) that is seen at `point_px`; nullopt where
// the distortion has no inverse.
std::optional<Eigen::Vector3d> PointSeenAt(const Camera& camera, const Eigen::Vector2d& point_px,
                                           double depth_mm);

// The root of a covariance's larger eigenvalue: the standard deviation in the worst direction.
double WorstSigma(const Eigen::Matrix2d& covariance);

}  // namespace glint
