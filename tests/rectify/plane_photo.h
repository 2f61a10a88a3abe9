// Photographs of a painted plane, made by supersampling: the truth that rectification must find
// again.
#pragma once

#include <Eigen/Geometry>
#include <cmath>
#include <functional>
#include <utility>

#include "base/camera/camera_model.h"
#include "base/camera/rigid3.h"
#include "base/images/image.h"
#include "base/photos/photo.h"

namespace glint {

// A camera `distance_mm` from the sample's centre, looking at it, tilted about the sample's x axis
// and turned about its own axis. At tilt 0 image x is sample x and image y is −sample y.
inline Rigid3 LookAtSample(double distance_mm, double tilt_deg, double roll_deg) {
  constexpr double kDegree = 3.14159265358979323846 / 180;
  const Eigen::Matrix3d upright = Eigen::Vector3d(1, -1, -1).asDiagonal();
  Rigid3 camera_from_sample;
  camera_from_sample.rotation = (Eigen::AngleAxisd(roll_deg * kDegree, Eigen::Vector3d::UnitZ()) *
                                 Eigen::AngleAxisd(tilt_deg * kDegree, Eigen::Vector3d::UnitX()))
                                    .toRotationMatrix() *
                                upright;
  camera_from_sample.translation = {0, 0, distance_mm};
  return camera_from_sample;
}

inline Camera TestCamera(int side_px, double focal_px, double k1 = 0, double k2 = 0) {
  Camera camera;
  camera.model = CameraModel::kRadial;
  camera.width_px = camera.height_px = side_px;
  camera.parameters = {focal_px, side_px / 2.0 + 3.2, side_px / 2.0 - 1.7, k1, k2};
  return camera;
}

// Point of the plane z = 0 that the image point shows.
inline std::pair<double, double> PlaneFromImage(const Camera& camera, const Rigid3& pose,
                                                double x_px, double y_px) {
  const auto uv = NormalizedFromImage(camera, {x_px, y_px});
  const Rigid3 sample_from_camera = Inverse(pose);
  const Eigen::Vector3d ray = sample_from_camera.rotation * Eigen::Vector3d(uv->x(), uv->y(), 1);
  const double t = -sample_from_camera.translation.z() / ray.z();
  const Eigen::Vector3d point = sample_from_camera.translation + t * ray;
  return {point.x(), point.y()};
}

// Linear photograph (floats) of a plane painted with `radiance(x_mm, y_mm)`, the mean of
// supersamples² rays a pixel.
inline Photo PhotographPlane(const Camera& camera, const Rigid3& pose,
                             const std::function<double(double, double)>& radiance,
                             int supersamples) {
  Photo photo;
  photo.bits = 32;
  Image image(camera.width_px, camera.height_px, {"R", "G", "B"});
  for (int y = 0; y < camera.height_px; ++y) {
    for (int x = 0; x < camera.width_px; ++x) {
      double sum = 0;
      for (int j = 0; j < supersamples; ++j) {
        for (int i = 0; i < supersamples; ++i) {
          const auto [x_mm, y_mm] = PlaneFromImage(camera, pose, x + (i + 0.5) / supersamples,
                                                   y + (j + 0.5) / supersamples);
          sum += radiance(x_mm, y_mm);
        }
      }
      const float mean = static_cast<float>(sum / (supersamples * supersamples));
      for (int c = 0; c < 3; ++c) {
        image.channel(c)[static_cast<size_t>(y) * camera.width_px + x] = mean;
      }
    }
  }
  photo.image = Stored(image, photo.bits);
  return photo;
}

// A photo of what such planes show; `bits` as stored.
inline Photo PhotoOf(const Image& stored, int bits) {
  Photo photo;
  photo.bits = bits;
  photo.image = Stored(stored, bits);
  return photo;
}

inline Image FlatImage(int width, int height, float stored) {
  Image image(width, height, {"R", "G", "B"});
  std::fill(image.samples.begin(), image.samples.end(), stored);
  return image;
}

// A photo of one level.
inline Photo FlatPhoto(int width, int height, float stored, int bits) {
  return PhotoOf(FlatImage(width, height, stored), bits);
}

}  // namespace glint
