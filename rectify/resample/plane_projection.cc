#include "rectify/resample/plane_projection.h"

#include <limits>
#include <utility>

namespace glint {
namespace {

// Squared radius in normalised coordinates up to which the radial distortion grows with the radius.
double MonotoneRadius2(Camera camera) {
  constexpr double kWidest = 4;  // tan of 76° off the axis, wider than any lens these models fit
  constexpr double kStep = 1e-3;
  for (size_t i = 0; i < camera.parameters.size(); ++i) {
    if (InfoOf(camera.model).parameters[i].of_a_vector()) camera.parameters[i] = 0;
  }
  double previous_px = -std::numeric_limits<double>::infinity();
  for (double r = 0; r < kWidest; r += kStep) {
    double x_px, y_px;
    ImageFromNormalized(camera.model, camera.parameters.data(), r, 0.0, &x_px, &y_px);
    if (!(x_px > previous_px)) return (r - kStep) * (r - kStep);
    previous_px = x_px;
  }
  return std::numeric_limits<double>::infinity();
}

}  // namespace

CameraProjection::CameraProjection(Camera camera, Rigid3 camera_from_sample)
    : camera_(std::move(camera)),
      camera_from_sample_(std::move(camera_from_sample)),
      max_r2_(MonotoneRadius2(camera_)) {}

std::optional<Eigen::Vector2d> CameraProjection::ImageFromPlane(double x_mm, double y_mm) const {
  const Eigen::Vector3d point = camera_from_sample_.rotation.col(0) * x_mm +
                                camera_from_sample_.rotation.col(1) * y_mm +
                                camera_from_sample_.translation;
  if (!(point.z() > 0)) return std::nullopt;
  if (point.head<2>().squaredNorm() > max_r2_ * point.z() * point.z()) return std::nullopt;
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

std::optional<Eigen::Vector2d> MovedProjection::ImageFromPlane(double x_mm, double y_mm) const {
  const Eigen::Vector3d point = plane_from_plane_ * Eigen::Vector3d(x_mm, y_mm, 1);
  if (!(point.z() > 0)) return std::nullopt;
  return projection_.ImageFromPlane(point.x() / point.z(), point.y() / point.z());
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
