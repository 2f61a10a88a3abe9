#include "calib/validation/diagnosis.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "calib/validation/diagnosis_picture.h"
#include "tests/calib/testing/board_scene.h"

namespace glint {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using testing::MakeScene;
using ::testing::Not;
using testing::PhoneCamera;
using testing::SceneSettings;

struct Diagnosed {
  BundleResult result;
  Diagnosis diagnosis;
};

Diagnosed Diagnose(const SceneSettings& settings, bool bend = false) {
  BundleOptions options;
  options.model = CameraModel::kRadial;
  options.bend = bend;
  const auto scene = MakeScene(PhoneCamera(options.model), settings);
  Diagnosed out{AdjustBundle(scene.problem, options), {}};
  out.diagnosis = Diagnose(scene.problem, options, out.result);
  return out;
}

std::vector<int> Found(const Diagnosis& diagnosis, bool PhotoPattern::*what) {
  std::vector<int> photos;
  for (size_t i = 0; i < diagnosis.photos.size(); ++i) {
    if (diagnosis.photos[i].*what) photos.push_back(static_cast<int>(i));
  }
  return photos;
}

TEST(Diagnosis, FindsNothingInGoodPhotographs) {
  for (int seed = 1; seed <= 4; ++seed) {
    SceneSettings settings;
    settings.seed = seed;
    EXPECT_THAT(Diagnose(settings).diagnosis.words, IsEmpty()) << seed;
  }
}

TEST(Diagnosis, FindsNothingInExactCorners) {
  SceneSettings settings;
  settings.noise_px = 0;
  const auto [result, diagnosis] = Diagnose(settings);
  EXPECT_LT(result.rms_px, 1e-6);
  EXPECT_THAT(diagnosis.words, IsEmpty());
}

TEST(Diagnosis, FindsABentBoardAndItsHeights) {
  SceneSettings settings;
  settings.bend_mm = {0.8, -0.3};
  const auto [result, diagnosis] = Diagnose(settings);
  ASSERT_TRUE(diagnosis.bend);
  EXPECT_TRUE(diagnosis.board_is_bent);
  ASSERT_EQ(diagnosis.words.size(), 1u);
  EXPECT_THAT(diagnosis.words[0], HasSubstr("--board-shape bent"));
  for (int i = 0; i < 2; ++i) {
    EXPECT_LE(std::abs(diagnosis.bend->height_mm[i] - settings.bend_mm[i]),
              4 * std::sqrt(diagnosis.bend->covariance(i, i)));
  }
  // Places in the middle of an edge stand off the plane that the corners span.
  double largest_mm = 0;
  for (const PlaceMean& place : diagnosis.places) {
    largest_mm = std::max(largest_mm, std::abs(place.offset_mm.z()));
  }
  EXPECT_GT(largest_mm, 0.15);
}

TEST(Diagnosis, ABendThatIsSolvedForMendsIntrinsicsAndResiduals) {
  SceneSettings settings;
  settings.bend_mm = {1.5, 0.5};
  const BundleResult flat = Diagnose(settings).result;
  const BundleResult bent = Diagnose(settings, true).result;
  EXPECT_GT(flat.rms_px, 1.5 * bent.rms_px);
  EXPECT_NEAR(bent.rms_px, 0.15 * std::sqrt(2.0), 0.01);
  const CameraEstimate& camera = bent.cameras[0];
  const Camera truth = PhoneCamera(CameraModel::kRadial);
  for (size_t i = 0; i < truth.parameters.size(); ++i) {
    EXPECT_LE(std::abs(camera.camera.parameters[i] - truth.parameters[i]), 4 * camera.sigma[i]);
  }
  EXPECT_LE((bent.bend->height_mm - settings.bend_mm).norm(),
            4 * std::sqrt(bent.bend->covariance.trace()));
  EXPECT_THAT(bent.BriefReport(), HasSubstr("board: rises by"));
}

TEST(Diagnosis, FindsPhotographsReadWhileThePhoneMoved) {
  SceneSettings settings;
  settings.moved = {2, 7};
  settings.motion_mm = {0.3, 0.1, 0.5};
  const auto [result, diagnosis] = Diagnose(settings);
  EXPECT_THAT(Found(diagnosis, &PhotoPattern::moved_while_read), ElementsAre(2, 7));
  ASSERT_THAT(diagnosis.words, Not(IsEmpty()));
  EXPECT_THAT(diagnosis.words[0], HasSubstr("2 of 12 photographs (photo2.jpg, photo7.jpg)"));
  EXPECT_THAT(diagnosis.words[0], HasSubstr("rolling shutter"));
}

// A lens with fewer terms than it has leaves smooth residuals in all photographs, which must not be
// put down to motion.
TEST(Diagnosis, DoesNotTakeAPoorModelForMotion) {
  Camera camera = PhoneCamera(CameraModel::kOpenCv);
  camera.parameters[4] = 0.2;
  camera.parameters[5] = -0.5;
  BundleOptions options;
  options.model = CameraModel::kSimpleRadial;
  const auto problem = MakeScene(camera, {}).problem;
  const Diagnosis diagnosis = glint::Diagnose(problem, options, AdjustBundle(problem, options));
  EXPECT_THAT(Found(diagnosis, &PhotoPattern::moved_while_read), IsEmpty());
  ASSERT_THAT(diagnosis.words, Not(IsEmpty()));
  EXPECT_THAT(diagnosis.words[0], HasSubstr("--model auto"));
}

TEST(Diagnosis, FindsThePhotographBlurredByMotion) {
  SceneSettings settings;
  settings.blurred = {5};
  settings.blur_px = 0.5;
  const auto [result, diagnosis] = Diagnose(settings);
  EXPECT_THAT(Found(diagnosis, &PhotoPattern::scattered_on_a_line), ElementsAre(5));
  EXPECT_NEAR(diagnosis.photos[5].axis_deg, settings.blur_deg, 8);
  ASSERT_EQ(diagnosis.words.size(), 1u);
  EXPECT_THAT(diagnosis.words[0], HasSubstr("blurred by motion"));
}

TEST(DiagnosisPicture, ShowsPlacesAndPhotos) {
  SceneSettings settings;
  settings.bend_mm = {0.8, 0};
  const auto [result, diagnosis] = Diagnose(settings);
  for (const Image& picture :
       {PlacesPicture(diagnosis, 500), PhotosPicture(result, diagnosis, 0, 600)}) {
    int ink = 0;
    for (const float value : picture.channel(1)) ink += value < 0.7f;
    EXPECT_GT(ink, 1000);
  }
  EXPECT_GT(PlacesPicture({}, 300).height, 0);  // nothing seen often enough
}

}  // namespace
}  // namespace glint
