// Photographs of a sample of 100 × 100 mm as geometry alone.
#pragma once

#include "calib/guidance/verdict.h"
#include "tests/calib/testing/synthetic_photo.h"

namespace glint::testing {

// A phone of 12 megapixels with a 26 mm lens, the flash 10 mm beside it.
inline GuidancePhoto PhotoFrom(double distance_mm, double tilt_deg, double azimuth_deg,
                               const std::string& name = "p.jpg") {
  GuidancePhoto photo;
  photo.name = name;
  PosedCamera posed;
  posed.camera = {CameraModel::kRadial, 4000, 3000, {3000, 2000, 1500, 0.05, -0.08}};
  posed.camera_from_sample = LookAt(distance_mm, tilt_deg, azimuth_deg, 0);
  const Rigid3 sample_from_camera = Inverse(posed.camera_from_sample);
  photo.camera_in_sample_mm = sample_from_camera.translation;
  photo.light_in_sample_mm = sample_from_camera * Eigen::Vector3d(10, 0, 0);
  photo.posed = posed;
  return photo;
}

// Twelve photographs to which nothing is missing: one from the top, five near it, six tilted.
inline GuidanceInput GoodCapture() {
  GuidanceInput input;
  input.sample_size_mm = {100, 100};
  input.resolution_px = {512, 512};
  input.focal_sigma = 0.001;
  input.photos.push_back(PhotoFrom(300, 0, 0, "top.jpg"));
  for (int i = 0; i < 5; ++i) {
    input.photos.push_back(PhotoFrom(300, 9, 72 * i, "near" + std::to_string(i) + ".jpg"));
  }
  for (int i = 0; i < 6; ++i) {
    input.photos.push_back(PhotoFrom(310, 30, 60 * i + 20, "side" + std::to_string(i) + ".jpg"));
  }
  return input;
}

}  // namespace glint::testing
