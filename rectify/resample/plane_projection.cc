#include "rectify/resample/plane_projection.h"

#include <utility>

namespace glint {

CameraProjection::CameraProjection(Camera camera, Rigid3 camera_from_sample)
    : camera_(std::move(camera)), camera_from_sample_(std::move(camera_from_sample)) {}

std::optional<Eigen::Vector2d> CameraProjection::ImageFromPlane(double x_mm, double y_mm) const {
  const Eigen::Vector3d point = camera_from_sample_.rotation.col(0) * x_mm +
                                camera_from_sample_.rotation.col(1) * y_mm +
                                camera_from_sample_.translation;
  if (!(point.z() > 0)) return std::nullopt;
  return ImageFromCamera(camera_, point);
}

HomographyProjection::HomographyProjection(const Eigen::Matrix3d& image_from_plane)
    : image_from_plane_(image_from_plane) {}

std::optional<Eigen::Vector2d> HomographyProjection::ImageFromPlane(double x_mm,
                                                                    double y_mm) const {
  const Eigen::Vector3d point = image_from_plane_ * Eigen::Vector3d(x_mm, y_mm, 1);
  if (!(point.z() > 0)) return std::nullopt;
  return Eigen::Vector2d(point.x() / point.z(), point.y() / point.z());
}

HomographyProjection TopViewProjection(const SamplePlane& plane, int width_px, int height_px) {
  // Corner to corner: the extent runs from the centre of the first pixel to that of the last.
  const bool corners = plane.sampling == TexelSampling::kCornerToCorner;
  const double inset_px = corners ? 1 : 0;
  const double sx = (width_px - inset_px) / plane.width_mm;
  const double sy = (height_px - inset_px) / plane.height_mm;
  Eigen::Matrix3d image_from_plane;
  image_from_plane << sx, 0, width_px / 2.0, 0, -sy, height_px / 2.0, 0, 0, 1;
  return HomographyProjection(image_from_plane);
}

}  // namespace glint
