// Where points of the sample's plane fall in a picture.
#pragma once

#include <Eigen/Core>
#include <optional>

#include "base/camera/camera_model.h"
#include "base/camera/rigid3.h"
#include "base/reflectance/view.h"

namespace glint {

class PlaneProjection {
 public:
  virtual ~PlaneProjection() = default;
  // Image point (centre of the top-left pixel at (0.5, 0.5)) of the point (x, y, 0) of the sample
  // frame; nullopt when it has none (behind the camera).
  virtual std::optional<Eigen::Vector2d> ImageFromPlane(double x_mm, double y_mm) const = 0;
};

// A photograph: pose, then the camera's lens. The plane's homography and the lens distortion are
// one mapping here, so that a photo is resampled once. Points farther from the axis than where the
// radial polynomial turns back have no image: beyond, it would show them a second time.
class CameraProjection : public PlaneProjection {
 public:
  CameraProjection(Camera camera, Rigid3 camera_from_sample);
  std::optional<Eigen::Vector2d> ImageFromPlane(double x_mm, double y_mm) const override;

 private:
  Camera camera_;
  Rigid3 camera_from_sample_;
  double max_r2_;  // of (u, v)
};

// A plain homography: image_from_plane · (x_mm, y_mm, 1).
class HomographyProjection : public PlaneProjection {
 public:
  explicit HomographyProjection(const Eigen::Matrix3d& image_from_plane);
  std::optional<Eigen::Vector2d> ImageFromPlane(double x_mm, double y_mm) const override;

 private:
  Eigen::Matrix3d image_from_plane_;
};

// A projection whose plane is moved by a homography of its points first: `plane_from_plane` ·
// (x_mm, y_mm, 1) is where the other says what is seen. What registration finds of a photograph.
class MovedProjection : public PlaneProjection {
 public:
  // `projection` must outlive this.
  MovedProjection(const PlaneProjection& projection, const Eigen::Matrix3d& plane_from_plane)
      : projection_(projection), plane_from_plane_(plane_from_plane) {}
  std::optional<Eigen::Vector2d> ImageFromPlane(double x_mm, double y_mm) const override;

 private:
  const PlaneProjection& projection_;
  Eigen::Matrix3d plane_from_plane_;
};

// A picture that shows the plane already from the top: a rectified view of width_px × height_px
// that fills the plane's extent, sampled as the plane says.
HomographyProjection TopViewProjection(const SamplePlane& plane, int width_px, int height_px);

}  // namespace glint
