// How well a calibrated camera projects, over its whole image.
//
// The covariance C of the intrinsics becomes one of image points by
//   δq = (∂q/∂k + ∂q/∂motion · M) δk,
// where M is the motion of the camera's frame that δk implies (implied_motion.h): what remains is
// what no rigid motion of the camera can undo. Where corners were seen it is small; where none
// were, it grows, which no reprojection error shows.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "calib/bundle/bundle.h"

namespace glint {

class ProjectionUncertainty {
 public:
  // `points_in_camera`: what the camera saw; see SeenPoints.
  ProjectionUncertainty(const CameraEstimate& estimate,
                        const std::vector<Eigen::Vector3d>& points_in_camera);

  // Covariance (px²) of the image of the point at `depth_mm` that is seen at `point_px`; nullopt
  // where the distortion has no inverse.
  std::optional<Eigen::Matrix2d> At(const Eigen::Vector2d& point_px, double depth_mm) const;
  Eigen::Matrix2d At(const Eigen::Vector3d& point_in_camera) const;

  double median_depth_mm() const { return median_depth_mm_; }  // of the points seen

 private:
  CameraEstimate estimate_;
  Eigen::MatrixXd motion_;  // 6 × parameters
  double median_depth_mm_ = 0;
};

// Points spread evenly over a picture, row by row, at the centres of columns × rows cells.
struct ImageGrid {
  int columns = 0, rows = 0;
  std::vector<Eigen::Vector2d> points_px;
};
// Cells as square as they can be, `columns` on the longer side.
ImageGrid GridOver(const Camera& camera, int columns = 40);

// Standard deviation in the worst direction on a grid, at the depth where the board was.
struct UncertaintyMap {
  ImageGrid grid;
  double depth_mm = 0;
  std::vector<double> sigma_px;  // NaN where the distortion has no inverse
  double centre_px = 0;          // the figure at the picture's centre
  double median_px = 0, largest_px = 0;
};
UncertaintyMap MapUncertainty(const BundleResult& result, int camera);

}  // namespace glint
