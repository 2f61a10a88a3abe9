#include "calib/light/power.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/calib/testing/synthetic_photo.h"

namespace glint {
namespace {

// Lambertian paper of reflectance 0.85 under a light of known power, at 60 spots.
LitPaper MakePaper(double tilt_deg, const Eigen::Vector3d& power, double exposure,
                   const Eigen::Vector3d& ambient) {
  LitPaper photo;
  photo.camera_from_sample = testing::LookAt(300, tilt_deg, 40 * tilt_deg, 10);
  photo.light_in_camera_mm = {12, -5, 3};
  photo.exposure = exposure;
  const Eigen::Vector3d light = Inverse(photo.camera_from_sample) * photo.light_in_camera_mm;
  for (int i = 0; i < 60; ++i) {
    const Eigen::Vector2d at(15.0 * (i % 10) - 70, 20.0 * (i / 10) - 50);
    const Eigen::Vector3d way = light - Eigen::Vector3d(at.x(), at.y(), 0);
    const Eigen::Vector3d irradiance = power * (way.z() / std::pow(way.norm(), 3)) + ambient;
    photo.samples.push_back({at, exposure * 0.85 / std::numbers::pi * irradiance});
  }
  return photo;
}

TEST(EstimatePower, InvertsLambertsLawPerChannel) {
  const Eigen::Vector3d power(2e5, 1.8e5, 1.5e5), ambient(0.05, 0.06, 0.07);
  std::vector<LitPaper> photos;
  for (int i = 0; i < 5; ++i) photos.push_back(MakePaper(8 * i, power, 1 + 0.2 * i, ambient));
  PowerOptions options;
  options.ambient = ambient;
  const PowerEstimate estimate = EstimatePower(photos, options);
  ASSERT_TRUE(estimate.known);
  EXPECT_TRUE(estimate.light_rgb.isApprox(power, 1e-12));
  EXPECT_LT(estimate.spread, 1e-12);
  EXPECT_EQ(estimate.samples, 300);
}

TEST(EstimatePower, IsNotMovedByCoveredSpotsNorByOneGlossyPhoto) {
  const Eigen::Vector3d power(2e5, 2e5, 2e5);
  std::vector<LitPaper> photos;
  for (int i = 0; i < 5; ++i) photos.push_back(MakePaper(8 * i, power, 1, {0, 0, 0}));
  for (LitPaper& photo : photos) {
    for (size_t k = 0; k < 20; ++k) photo.samples[k].radiance *= k % 2 ? 0.3 : 2.5;
  }
  for (PaperSample& sample : photos[2].samples) sample.radiance *= 1.7;
  const PowerEstimate estimate = EstimatePower(photos, {});
  EXPECT_NEAR(estimate.light_rgb.x() / 2e5, 1, 1e-9);
  EXPECT_NEAR(estimate.photo_power[2] / 2e5, 1.7, 1e-9);
}

TEST(EstimatePower, IsUnknownWithoutPaper) {
  EXPECT_FALSE(EstimatePower({}, {}).known);
  LitPaper bare;
  bare.camera_from_sample = testing::LookAt(300, 5, 0, 0);
  const PowerEstimate estimate = EstimatePower({bare}, {});
  EXPECT_FALSE(estimate.known);
  EXPECT_EQ(estimate.photo_power.size(), 1u);
}

TEST(SamplePaper, FindsWhitePaperAndLeavesOutWhatClips) {
  const Board board = testing::SmallBoard();
  const Camera camera{CameraModel::kRadial, 800, 600, {720, 404.3, 297.1, 0.06, -0.08}};
  testing::PhotoSettings settings;
  settings.vignette = 0;
  settings.noise = 1;
  settings.samples = 3;
  for (const double peak : {0.9, 2.0}) {
    settings.peak = peak;
    const GrayImage gray =
        testing::Photograph(board, camera, testing::LookAt(240, 15, 40, 5), settings);
    Photo photo;
    photo.image = Stored(testing::RgbOf(gray), 8);
    const auto detection = DetectBoard(gray, board);
    const auto samples =
        SamplePaper(photo, Encoding::kGamma22, board, PaperSpots(board), detection.corners);
    if (peak > 1) {
      EXPECT_TRUE(samples.empty());
      continue;
    }
    EXPECT_GE(samples.size(), 70u);
    for (const PaperSample& sample : samples) {
      EXPECT_NEAR(sample.radiance.y(), settings.paper * peak, 0.02);
    }
  }
}

}  // namespace
}  // namespace glint
