#include "datasets/evaluation/calibration_error.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/errors/errors.h"
#include "datasets/synth/capture_plan.h"

namespace glint {
namespace {

using Eigen::Vector3d;

const Eigen::Vector2d kSize(100, 100);

Calibration Truth() {
  CapturePlanOptions options;
  options.photos = 4;
  const CapturePlan plan = PlanCapture(options);
  Calibration calibration;
  calibration.cameras = {plan.camera};
  calibration.light_rgb = plan.light_rgb;
  calibration.light_power_known = true;
  for (int i = 0; i < 4; ++i) {
    CalibratedPhoto photo;
    photo.photo = "photo_" + std::to_string(i);
    photo.camera_from_sample = plan.photos[i].camera_from_sample;
    photo.light_in_camera_mm = {10, 0, 0};
    calibration.photos.push_back(photo);
  }
  return calibration;
}

TEST(CompareCalibrations, TheTruthHasNoError) {
  const CalibrationErrors errors = CompareCalibrations(Truth(), Truth(), kSize);
  EXPECT_EQ(errors.focal_length_percent, 0);
  EXPECT_NEAR(errors.largest_position_percent, 0, 1e-9);
  EXPECT_NEAR(errors.corner_rms_texel, 0, 1e-8);
  EXPECT_EQ(errors.light_power_percent, 0);
  EXPECT_EQ(errors.missing_photos, 0);
}

TEST(CompareCalibrations, FocalLengthErrorIsRelative) {
  Calibration estimate = Truth();
  estimate.cameras[0].parameters[0] *= 1.002;
  EXPECT_NEAR(CompareCalibrations(Truth(), estimate, kSize).focal_length_percent, 0.2, 1e-9);
}

TEST(CompareCalibrations, AModelWithMoreParametersIsComparedAlike) {
  Calibration estimate = Truth();
  const std::vector<double> p = Truth().cameras[0].parameters;
  estimate.cameras[0].model = CameraModel::kOpenCv;
  estimate.cameras[0].parameters = {p[0], p[0] * 0.999, p[1], p[2], p[3], p[4], 0, 0};
  EXPECT_NEAR(CompareCalibrations(Truth(), estimate, kSize).focal_length_percent, 0.1, 1e-9);
}

TEST(CompareCalibrations, ACameraMovedBackIsOffByItsShareOfTheDistance) {
  Calibration estimate = Truth();
  Rigid3& pose = estimate.photos[2].camera_from_sample;
  const Vector3d camera = Inverse(pose).translation;
  pose.translation = -(pose.rotation * (1.003 * camera));
  const CalibrationErrors errors = CompareCalibrations(Truth(), estimate, kSize);
  EXPECT_NEAR(errors.photos[2].position_percent, 0.3, 1e-9);
  EXPECT_NEAR(errors.photos[2].rotation_deg, 0, 1e-5);
  EXPECT_NEAR(errors.largest_position_percent, 0.3, 1e-9);
  EXPECT_NEAR(errors.mean_position_percent, 0.075, 1e-9);
}

// The sample frame shifted by 1 mm: every rectified corner is off by 1 mm = 10.24 texels.
TEST(CompareCalibrations, AShiftedSampleShiftsRectifiedCorners) {
  Calibration estimate = Truth();
  for (CalibratedPhoto& photo : estimate.photos) {
    photo.camera_from_sample.translation +=
        photo.camera_from_sample.rotation * Vector3d(0.6, -0.8, 0);
  }
  const CalibrationErrors errors = CompareCalibrations(Truth(), estimate, kSize);
  EXPECT_NEAR(errors.corner_rms_texel, 10.24, 1e-6);
  EXPECT_NEAR(errors.largest_corner_rms_texel, 10.24, 1e-6);
}

TEST(CompareCalibrations, PhotosAreMatchedByNameAndMissingOnesCounted) {
  Calibration estimate = Truth();
  std::swap(estimate.photos[0], estimate.photos[3]);
  estimate.photos.erase(estimate.photos.begin() + 1);
  const CalibrationErrors errors = CompareCalibrations(Truth(), estimate, kSize);
  EXPECT_EQ(errors.missing_photos, 1);
  EXPECT_NEAR(errors.largest_position_percent, 0, 1e-9);
  estimate.photos.clear();
  EXPECT_THROW(CompareCalibrations(Truth(), estimate, kSize), UserError);
}

TEST(CompareCalibrations, LightPowerCountsOnlyWhereItIsClaimed) {
  Calibration estimate = Truth();
  estimate.light_rgb.y() *= 1.05;
  EXPECT_NEAR(CompareCalibrations(Truth(), estimate, kSize).light_power_percent, 5, 1e-9);
  estimate.light_power_known = false;
  EXPECT_EQ(CompareCalibrations(Truth(), estimate, kSize).light_power_percent, 0);
}

TEST(AlignCalibration, TakesFrameAndScaleAwayAndLeavesTheRest) {
  Similarity3 other;
  other.scale = 0.02;
  other.rotation = Eigen::AngleAxisd(1.2, Vector3d(1, 2, -1).normalized()).toRotationMatrix();
  other.translation = {5, -3, 8};
  Calibration estimate = Truth();
  estimate.light_rgb *= other.scale * other.scale;
  for (CalibratedPhoto& photo : estimate.photos) {
    photo.camera_from_sample = MovedPose(photo.camera_from_sample, other);
    photo.light_in_camera_mm *= other.scale;
  }
  Similarity3 found;
  const Calibration aligned = AlignCalibration(Truth(), estimate, &found);
  const CalibrationErrors errors = CompareCalibrations(Truth(), aligned, kSize);
  EXPECT_LT(errors.largest_position_percent, 1e-9);
  EXPECT_LT(errors.corner_rms_texel, 1e-6);
  EXPECT_LT(errors.light_power_percent, 1e-9);
  EXPECT_NEAR(found.scale, 50, 1e-9);
  // One camera off by 3 mm is not taken away.
  estimate.photos[1].camera_from_sample.translation.x() += 3 * other.scale;
  const Calibration worse = AlignCalibration(Truth(), estimate);
  EXPECT_GT(CompareCalibrations(Truth(), worse, kSize).largest_position_percent, 0.2);
}

TEST(AlignCalibration, NeedsThreePhotographs) {
  Calibration estimate = Truth();
  estimate.photos.resize(2);
  EXPECT_THROW(AlignCalibration(Truth(), estimate), UserError);
}

}  // namespace
}  // namespace glint
