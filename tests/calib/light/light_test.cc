#include "calib/light/light.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "base/camera/orientation.h"
#include "base/colour/srgb.h"
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
      const int column = k % 18, row = k / 18;
      const Vector3d spot(13.0 * column - 110, 13.0 * row - 84, 0);
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
  for (int tenth = 1; tenth <= 7; ++tenth) {  // as far as paper is seen
    const double r = tenth / 10.0;
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

// Radiance follows the bend, the fall-off of the lens (0.5 % here) does not.
TEST(EstimateLight, FollowsTheBendOfThePaper) {
  LightProblem problem = MakeProblem(12, {}, false, 12);
  const LightEstimate flat = EstimateLight(problem);
  BoardBend bend;
  bend.half_size_mm = {115, 90};
  bend.height_mm = {3, 0};
  problem.bend = bend;
  const Vector3d flash(Truth().flash_mm);
  for (LightPhoto& photo : problem.photos) {
    const Rigid3 sample_from_camera = Inverse(photo.camera_from_sample);
    const Vector3d light_mm = sample_from_camera * flash;
    const auto shown = [&](const Vector3d& spot, const Vector3d& normal) {
      const Vector3d way = light_mm - spot;
      return way.dot(normal) / std::pow(way.norm(), 3);
    };
    for (PaperSample& sample : photo.samples) {
      const Vector2d at = sample.position_in_sample_mm;
      const double slope = -2 * 3 * at.x() / (115.0 * 115.0);
      const Vector3d spot(at.x(), at.y(), 3 * (1 - at.x() * at.x() / (115.0 * 115.0)));
      sample.radiance *=
          shown(spot, Vector3d(-slope, 0, 1).normalized()) / shown({at.x(), at.y(), 0}, {0, 0, 1});
    }
  }
  const LightEstimate bent = EstimateLight(problem);
  ASSERT_TRUE(bent.known) << bent.problem;
  for (int i = 0; i < 3; ++i) {
    EXPECT_NEAR(bent.flash_in_camera_mm[i].value, flat.flash_in_camera_mm[i].value, 0.5);
    EXPECT_NEAR(bent.power_rgb[i].value / flat.power_rgb[i].value, 1, 0.01);
  }
  problem.bend.reset();
  EXPECT_GT(std::abs(EstimateLight(problem).power_rgb[1].value / flat.power_rgb[1].value - 1),
            0.01);
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
  EXPECT_NE(light.held.back().find("fixed at 0"), std::string::npos);
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

// Of photographs as they should be.
void ExpectUncontradicted(const LightEstimate& light) {
  ASSERT_TRUE(light.known) << light.problem;
  EXPECT_FALSE(light.tone);
  EXPECT_FALSE(light.flash_along_free);
  for (const LightOfPhoto& photo : light.photos) {
    EXPECT_FALSE(photo.contradicts) << photo.name;
    EXPECT_EQ(photo.turns, 0) << photo.name;
    EXPECT_LT(photo.colour.maxCoeff() / photo.colour.minCoeff(), 1.01) << photo.name;
  }
}

// `exposure`: of the first photograph that is used, over the first's.
void ExpectTheLight(const LightEstimate& light, const Truth& truth, double exposure = 1) {
  ASSERT_TRUE(light.known) << light.problem;
  for (int c = 0; c < 3; ++c) {
    EXPECT_NEAR(light.flash_in_camera_mm[c].value, truth.flash_mm[c], 5) << c;
    EXPECT_NEAR(light.power_rgb[c].value / (exposure * kShown * truth.power[c]), 1, 0.08) << c;
  }
}

void MayBeUpsideDown(LightProblem* problem) {
  for (LightPhoto& photo : problem->photos) photo.possible_turns = {0, 2};
}

TEST(EstimateLight, FindsNothingWrongWithGoodPhotographs) {
  for (int photos : {6, 12}) {
    LightProblem problem = MakeProblem(photos, {}, false, photos);
    MayBeUpsideDown(&problem);
    ExpectUncontradicted(EstimateLight(problem));
  }
}

TEST(EstimateLight, FindsPixelsThatWereTurned) {
  for (int photos : {6, 12}) {
    LightProblem problem = MakeProblem(photos, {}, false, 2);
    MayBeUpsideDown(&problem);
    for (const int i : {1, 4}) {
      problem.photos[i].camera_from_sample = TurnedPose(problem.photos[i].camera_from_sample, 2);
    }
    const LightEstimate light = EstimateLight(problem);
    ExpectTheLight(light, {});
    for (int i = 0; i < photos; ++i) EXPECT_EQ(light.photos[i].turns, i == 1 || i == 4 ? 2 : 0);
  }
}

TEST(EstimateLight, LeavesOutAnEnlargedPhotographAndTellsByHowMuch) {
  for (int photos : {6, 12}) {
    LightProblem problem = MakeProblem(photos, {}, false, 4);
    problem.photos[0].camera_from_sample.translation.z() /= 1.25;  // as its corners say
    const LightEstimate light = EstimateLight(problem);
    ExpectTheLight(light, {}, ExposureOf(1) / ExposureOf(0));
    EXPECT_TRUE(light.photos[0].contradicts);
    EXPECT_FALSE(light.photos[0].used);
    EXPECT_NEAR(light.photos[0].zoom, 1.25, 0.07);
    for (int i = 1; i < photos; ++i) EXPECT_TRUE(light.photos[i].used) << i;
  }
}

TEST(EstimateLight, KeepsAPhotographOfAnotherFlashPowerWithItsOwnExposure) {
  LightProblem problem = MakeProblem(8, {}, false, 6);
  for (PaperSample& sample : problem.photos[3].samples) sample.radiance *= 1.4;
  const LightEstimate light = EstimateLight(problem);
  ExpectTheLight(light, {});
  EXPECT_TRUE(light.photos[3].contradicts);
  EXPECT_EQ(light.photos[3].zoom, 1);
  EXPECT_NEAR(light.photos[3].exposure.value / (1.4 * ExposureOf(3) / ExposureOf(0)), 1, 0.02);
}

TEST(EstimateLight, FindsTheToneCurveInPlaceOfAFlashElsewhere) {
  for (int photos : {6, 12}) {
    LightProblem problem = MakeProblem(photos, {}, false, 8);
    for (LightPhoto& photo : problem.photos) {
      for (PaperSample& sample : photo.samples) {
        for (double& value : sample.radiance) {  // shadows lifted, as phones do
          const double x = std::pow(value, 1 / 2.2);
          value = std::pow(x + 0.18 * std::sin(std::numbers::pi * x) * (0.6 - x), 2.2);
        }
      }
    }
    const LightEstimate light = EstimateLight(problem);
    ExpectTheLight(light, {});
    ASSERT_TRUE(light.tone);
    for (const double radiance : {0.2, 0.4, 0.6}) {  // of the paper
      const double x = std::pow(radiance, 1 / 2.2);
      const double read = std::pow(x + 0.18 * std::sin(std::numbers::pi * x) * (0.6 - x), 2.2);
      EXPECT_NEAR(light.tone->Linear(read) / radiance, 1, 0.08) << radiance;
    }
    LightOptions linear;
    linear.tone_known = true;
    EXPECT_FALSE(EstimateLight(problem, linear).tone);
  }
}

// Their exponents differ by 1 to 3 % where paper is seen, as if the flash were behind the lens.
TEST(EstimateLight, TellsSrgbsCurveFromGamma22) {
  LightOptions options;
  options.perhaps_srgb = true;
  for (const double exposed : {1.0, 0.3}) {
    const int photos = 12;
    Truth truth;
    truth.power *= exposed;
    truth.ambient *= exposed;
    LightProblem problem = MakeProblem(photos, truth, false, photos);
    EXPECT_FALSE(EstimateLight(problem, options).srgb) << exposed;
    for (LightPhoto& photo : problem.photos) {
      for (PaperSample& sample : photo.samples) {
        for (double& value : sample.radiance) value = std::pow(SrgbFromLinear(value), 2.2);
      }
    }
    const LightEstimate light = EstimateLight(problem, options);
    EXPECT_TRUE(light.srgb) << exposed;
    EXPECT_FALSE(light.tone);
    EXPECT_FALSE(light.flash_along_free);
    ExpectTheLight(light, truth);
    EXPECT_FALSE(EstimateLight(problem).srgb);  // where the encoding was told
  }
}

TEST(EstimateLight, BelievesAFlashBehindTheLensThatThePaperShows) {
  Truth truth;
  truth.flash_mm = {5, 60, -40};
  const LightEstimate light = EstimateLight(MakeProblem(12, truth, false, 9));
  ExpectTheLight(light, truth);
  EXPECT_TRUE(light.flash_along_free);
  EXPECT_FALSE(light.tone);
}

TEST(EstimateLight, FindsAWhiteBalanceThatDrifts) {
  LightProblem problem = MakeProblem(6, {}, false, 10);
  for (PaperSample& sample : problem.photos[2].samples) sample.radiance[2] *= 1.06;
  const LightEstimate light = EstimateLight(problem);
  ExpectTheLight(light, {});
  EXPECT_NEAR(light.photos[2].colour[2] / light.photos[2].colour[1], 1.06, 0.01);
  EXPECT_LT(light.photos[3].colour.maxCoeff() / light.photos[3].colour.minCoeff(), 1.01);
}

TEST(ToneCurve, OfSrgbReadsWhatItStored) {
  for (const double radiance : {0.0, 0.001, 0.05, 0.4, 1.0}) {
    const double by_gamma = std::pow(SrgbFromLinear(radiance), 2.2);
    EXPECT_NEAR(SrgbForGamma22(by_gamma), radiance, 1e-9);
  }
}

TEST(ToneCurve, IsInvertedAndRisesFromBlackToWhite) {
  ToneCurve tone;
  tone.t = {Estimate{0.1, 0}, {0.25, 0}, {0.03, 0}};
  tone.lowest = 0.15, tone.highest = 0.7;
  for (const double linear : {0.25, 0.4, 0.6}) {
    const double x = std::log(linear);
    EXPECT_NEAR(tone.Linear(std::exp(x * (1 + 0.1 + 0.25 * x + 0.03 * x * x))), linear, 1e-9);
  }
  double before = -1;
  for (int i = 0; i <= 255; ++i) {
    const double now = tone.Linear(i / 255.0);
    EXPECT_GT(now, before);
    before = now;
  }
  EXPECT_EQ(tone.Linear(0), 0);
  EXPECT_EQ(tone.Linear(1), 1);
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
