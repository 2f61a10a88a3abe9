#include "calib/light/light.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "calib/camera/orientation.h"
#include "tests/calib/testing/synthetic_photo.h"

namespace glint {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

struct Truth {
  Vector3d flash_mm{15, -4, 1}, power{2e5, 1.9e5, 1.7e5}, ambient{0.06, 0.065, 0.07};
  std::array<double, 3> vignetting{-0.32, 0.03, -0.01};
  double gloss = 0;  // of a lobe of roughness 0.6
  double noise = 0.01;
};

// π·f/ρ of the paper's lobe, written down apart from the code under test.
double Gloss(const Vector3d& light, const Vector3d& eye) {
  const Vector3d half = (light + eye).normalized();
  const double a = 0.36, k = a / 2;
  const double d = a * a / std::pow(half.z() * half.z() * (a * a - 1) + 1, 2) / std::numbers::pi;
  const auto smith = [&](double x) { return x / (x * (1 - k) + k); };
  return std::numbers::pi * d * smith(light.z()) * smith(eye.z()) / (4 * light.z() * eye.z());
}

double ExposureOf(int photo) { return std::exp2(std::fmod(0.37 * photo, 1.0) * 2 - 1); }

// Photographs of paper spots round a window. EXIF is a few percent off.
LightProblem MakeProblem(int photos, const Truth& truth, bool turned, int seed) {
  testing::Random random(static_cast<std::uint64_t>(seed) + 1);
  LightProblem problem;
  Camera camera{CameraModel::kRadial, 2000, 1500, {1500, 1008, 741, 0.05, -0.08}};
  problem.cameras = {camera};
  camera.vignetting = truth.vignetting;
  for (int i = 0; i < photos; ++i) {
    LightPhoto& photo = problem.photos.emplace_back();
    photo.name = "p" + std::to_string(i);
    photo.camera_from_sample =
        testing::LookAt(270 + 11 * (i % 6), i == 0 ? 2 : 8 + 3 * (i % 11), 137 * i, 7 * (i % 5));
    if (turned && i % 2 == 1) photo.camera_from_sample = TurnedPose(photo.camera_from_sample, 1);
    photo.exposure = ExposureOf(i) * (1 + 0.03 * random.Normal());
    const Rigid3 sample_from_camera = Inverse(photo.camera_from_sample);
    const Vector3d light_mm = sample_from_camera * truth.flash_mm;
    for (int k = 0; k < 18 * 14; ++k) {
      const Vector3d spot(13.0 * (k % 18) - 110, 13.0 * (k / 18) - 84, 0);
      if (std::abs(spot.x()) < 52 && std::abs(spot.y()) < 52) continue;
      const Vector2d pixel = ImageFromCamera(camera, photo.camera_from_sample * spot);
      if ((pixel.array() < 4).any() || pixel.x() > 1996 || pixel.y() > 1496) continue;
      const Vector3d way = light_mm - spot;
      const Vector3d eye = (sample_from_camera.translation - spot).normalized();
      const double geometry = way.z() / std::pow(way.norm(), 3);
      const double paper = 0.85 + truth.gloss * Gloss(way.normalized(), eye);
      const double seen =
          ExposureOf(i) / ExposureOf(0) * Vignetting(camera, pixel) / std::numbers::pi;
      Vector3d radiance = 0.4 * seen * (paper * geometry * truth.power + 0.85 * truth.ambient);
      for (int c = 0; c < 3; ++c) radiance[c] *= 1 + truth.noise * random.Normal();
      photo.samples.push_back({spot.head<2>(), radiance, k / 54 * 6 + k % 18 / 3, 8});
    }
  }
  return problem;
}

constexpr double kShown = 0.4;  // MakeProblem's power is this times the truth's

void ExpectWithin(const Estimate& estimate, double truth, double most, const char* what) {
  EXPECT_NEAR(estimate.value, truth, most) << what;
  EXPECT_GT(estimate.sigma, 0) << what;
  EXPECT_LT(std::abs(estimate.value - truth), 4 * estimate.sigma) << what;
}

TEST(EstimateLight, FindsFlashFalloffExposuresAndRoomLightOfTurnedPhotos) {
  const Truth truth;
  const LightProblem problem = MakeProblem(12, truth, true, 0);
  const LightEstimate light = EstimateLight(problem);
  ASSERT_TRUE(light.known) << light.problem;
  EXPECT_TRUE(light.held.empty());
  for (int i = 0; i < 3; ++i) {
    ExpectWithin(light.flash_in_camera_mm[i], truth.flash_mm[i], 1.0, "flash");
    ExpectWithin(light.power_rgb[i], kShown * truth.power[i], 0.01 * kShown * truth.power[i],
                 "power");
    ExpectWithin(light.ambient_rgb[i], kShown * truth.ambient[i], 0.15 * kShown * truth.ambient[i],
                 "ambient");
  }
  for (double r = 0.1; r < 0.75; r += 0.1) {  // as far as paper is seen
    double found = 1, right = 1;
    for (int i = 0; i < 3; ++i) {
      found += light.vignetting[0][i].value * std::pow(r, 2 * i + 2);
      right += truth.vignetting[i] * std::pow(r, 2 * i + 2);
    }
    EXPECT_NEAR(found, right, 0.01);
  }
  for (int i = 1; i < 12; ++i) {
    ExpectWithin(light.photos[i].exposure, ExposureOf(i) / ExposureOf(0), 0.01, "exposure");
  }
}

TEST(EstimateLight, TellsGlossyPaperFromTheLensesFalloff) {
  Truth truth;
  truth.gloss = 0.04;
  const LightEstimate light = EstimateLight(MakeProblem(12, truth, false, 3));
  ASSERT_TRUE(light.known);
  ExpectWithin(light.gloss, 0.04, 0.01, "gloss");
  ExpectWithin(light.flash_in_camera_mm[0], 15, 1.5, "flash");
}

TEST(EstimateLight, RejectsShadowsGlossAndWhatClips) {
  LightProblem problem = MakeProblem(12, {}, false, 5);
  const LightEstimate clean = EstimateLight(problem);
  int spoiled = 0;
  for (LightPhoto& photo : problem.photos) {
    for (size_t k = 0; k < photo.samples.size(); k += 9, ++spoiled) {
      photo.samples[k].radiance *= k % 2 ? 0.6 : 1.5;
    }
  }
  const LightEstimate light = EstimateLight(problem);
  ASSERT_TRUE(light.known);
  EXPECT_GE(light.samples - light.inliers, spoiled);
  EXPECT_LT(light.samples - light.inliers, spoiled + light.samples / 25);
  for (int i = 0; i < 3; ++i) {
    const Estimate& a = clean.flash_in_camera_mm[i];
    EXPECT_NEAR(light.flash_in_camera_mm[i].value, a.value, 2 * a.sigma);
  }
}

TEST(EstimateLight, HoldsWhatOnePhotoCannotTellAndSaysSo) {
  const Truth truth;
  const LightEstimate light = EstimateLight(MakeProblem(1, truth, false, 1));
  ASSERT_TRUE(light.known);
  ASSERT_GE(light.held.size(), 1u);
  EXPECT_NE(light.held.back().find("held at 0"), std::string::npos);
  for (int i = 0; i < 2; ++i) {
    const Estimate& flash = light.flash_in_camera_mm[i];
    EXPECT_LT(std::abs(flash.value - truth.flash_mm[i]), 4 * flash.sigma);
  }
}

TEST(EstimateLight, HoldsTheFlashWhereAFewSpotsCannotPlaceIt) {
  LightOptions options;
  options.offset_mm = {12, 3, 0};
  LightProblem problem = MakeProblem(1, {}, false, 1);
  problem.photos[0].samples.resize(14);
  const LightEstimate light = EstimateLight(problem, options);
  ASSERT_TRUE(light.known);
  EXPECT_EQ(light.held.size(), 4u);
  for (int i = 0; i < 3; ++i) {
    EXPECT_EQ(light.flash_in_camera_mm[i].value, options.offset_mm[i]);
    EXPECT_EQ(light.flash_in_camera_mm[i].sigma, 0);
    EXPECT_EQ(light.vignetting[0][i].value, 0);
    EXPECT_EQ(light.ambient_rgb[i].value, 0);
  }
}

TEST(EstimateLight, KeepsTheGivenPowerAndFindsThePaperInstead) {
  LightOptions options;
  options.power = {1e5, 1e5, 1e5};
  const LightEstimate light = EstimateLight(MakeProblem(12, {}, false, 0), options);
  ASSERT_TRUE(light.known);
  const Truth truth;
  for (int c = 0; c < 3; ++c) {
    EXPECT_EQ(light.power_rgb[c].value, 1e5);
    ExpectWithin(light.paper_rgb[c], 0.85 * kShown * truth.power[c] / 1e5, 0.01, "paper");
  }
}

TEST(EstimateLight, IsUnknownWithoutPaper) {
  EXPECT_FALSE(EstimateLight({}).known);
  LightProblem problem = MakeProblem(2, {}, false, 0);
  for (LightPhoto& photo : problem.photos) photo.samples.resize(3);
  const LightEstimate light = EstimateLight(problem);
  EXPECT_FALSE(light.known);
  EXPECT_FALSE(light.problem.empty());
}

}  // namespace
}  // namespace glint
