// The residual of the bundle adjustment, as a Ceres functor.
#pragma once

#include <ceres/rotation.h>

#include <Eigen/Core>

#include "calib/bundle/bundle.h"

namespace glint {

// Predicted minus seen image point. Parameter blocks: the camera's parameters in COLMAP's order,
// and a pose of six numbers (w, t) beside a fixed rotation R₀: point_in_camera = exp(w)·R₀·X + t.
// As w stays small, the parameterisation has no singular point in reach.
// Where the board's bend is solved for, its two heights (mm) are a third block.
class ReprojectionError {
 public:
  ReprojectionError(CameraModel model, const Eigen::Matrix3d& rotation0, const BundleCorner& corner,
                    const BoardBend& bend = {})
      : model_(model),
        flat_(rotation0.leftCols<2>() * corner.position_in_sample_mm),
        up_(rotation0.col(2)),
        bend_weights_(bend.Weights(corner.position_in_sample_mm)),
        known_height_mm_(bend.HeightAt(corner.position_in_sample_mm)),
        seen_px_(corner.point_px) {}

  template <class T>
  bool operator()(const T* camera, const T* pose, T* residual) const {
    return Evaluate(camera, pose, T(known_height_mm_), residual);
  }
  template <class T>
  bool operator()(const T* camera, const T* pose, const T* heights, T* residual) const {
    return Evaluate(camera, pose, heights[0] * bend_weights_.x() + heights[1] * bend_weights_.y(),
                    residual);
  }

 private:
  template <class T>
  bool Evaluate(const T* camera, const T* pose, const T& height, T* residual) const {
    const T rotated[3] = {flat_.x() + height * up_.x(), flat_.y() + height * up_.y(),
                          flat_.z() + height * up_.z()};
    T p[3];
    ceres::AngleAxisRotatePoint(pose, rotated, p);
    for (int i = 0; i < 3; ++i) p[i] += pose[3 + i];
    if (!(p[2] > 1e-9)) return false;  // behind the camera: Ceres takes a shorter step
    T x, y;
    ImageFromNormalized(model_, camera, T(p[0] / p[2]), T(p[1] / p[2]), &x, &y);
    residual[0] = x - seen_px_.x();
    residual[1] = y - seen_px_.y();
    return true;
  }

  CameraModel model_;
  Eigen::Vector3d flat_, up_;
  Eigen::Vector2d bend_weights_;
  double known_height_mm_;
  Eigen::Vector2d seen_px_;
};

}  // namespace glint
