#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "calib/validation/cross_validation.h"
#include "calib/validation/model_choice.h"
#include "calib/validation/scatter.h"
#include "tests/calib/testing/board_scene.h"

namespace glint {
namespace {

using ::testing::HasSubstr;
using testing::MakeScene;
using testing::PhoneCamera;
using testing::SceneSettings;

// A small version of bench_scatter: 40 draws of 8 photographs. A ratio's own standard deviation is
// 1/√80 for one parameter and less for what is averaged.
TEST(Scatter, OfRepetitionsIsWhatTheCovariancesPredict) {
  SceneSettings settings;
  settings.photos = 8;
  BundleOptions options;
  options.model = CameraModel::kRadial;
  const auto scene = MakeScene(PhoneCamera(options.model), settings);
  const BundleResult truth = AdjustBundle(scene.problem, options);
  const Scatter scatter =
      MeasureScatter(scene.problem, truth, options, {80, 80}, settings.noise_px, 40, 5);
  std::printf("%s", scatter.Text().c_str());
  ASSERT_EQ(scatter.intrinsics.size(), 5u);
  for (const ScatterLine& line : scatter.intrinsics) {
    EXPECT_NEAR(line.ratio(), 1, 0.33) << line.quantity;
  }
  for (const ScatterLine& line : {scatter.rotation, scatter.position, scatter.projections[0],
                                  scatter.projections[1], scatter.sample}) {
    EXPECT_NEAR(line.ratio(), 1, 0.2) << line.quantity;
  }
}

CrossValidation Validate(const BundleProblem& problem, CameraModel model) {
  BundleOptions options;
  options.model = model;
  return CrossValidate(problem, options, AdjustBundle(problem, options));
}

TEST(CrossValidation, TrueModelsDifferAsPredicted) {
  double sum = 0;
  for (const auto model : {CameraModel::kRadial, CameraModel::kOpenCv}) {
    for (int seed = 1; seed <= 3; ++seed) {
      SceneSettings settings;
      settings.seed = seed;
      const auto validation = Validate(MakeScene(PhoneCamera(model), settings).problem, model);
      ASSERT_EQ(validation.problem, "");
      EXPECT_TRUE(validation.trusted());
      EXPECT_NEAR(validation.held_out_rms_px, 0.15 * std::sqrt(2.0), 0.02);
      sum += validation.ratio() / 6;
    }
  }
  EXPECT_NEAR(sum, 1, 0.5);
}

// Without noise the prediction is next to nothing, and rounding errors are no fault of the model.
TEST(CrossValidation, TrustsExactCorners) {
  SceneSettings settings;
  settings.noise_px = 0;
  EXPECT_TRUE(
      Validate(MakeScene(PhoneCamera(CameraModel::kRadial), settings).problem, CameraModel::kRadial)
          .trusted());
}

TEST(CrossValidation, ShowsAModelThatIsTooSimple) {
  Camera camera = PhoneCamera(CameraModel::kOpenCv);
  camera.parameters[4] = 0.2;
  camera.parameters[5] = -0.5;
  const auto problem = MakeScene(camera, {}).problem;
  const auto simple = Validate(problem, CameraModel::kSimpleRadial);
  const auto right = Validate(problem, CameraModel::kOpenCv);
  ASSERT_EQ(simple.problem, "");
  EXPECT_GT(simple.held_out_rms_px, 2 * right.held_out_rms_px);
  ASSERT_EQ(simple.cameras.size(), 1u);
  EXPECT_GT(simple.cameras[0].rms_px, 2 * right.cameras[0].rms_px);
  EXPECT_FALSE(simple.trusted());
}

TEST(CrossValidation, SaysWhyThereIsNone) {
  SceneSettings settings;
  settings.photos = 3;
  auto problem = MakeScene(PhoneCamera(CameraModel::kRadial), settings).problem;
  EXPECT_THAT(Validate(problem, CameraModel::kRadial).problem, HasSubstr("4 are needed"));
  problem.cameras[0].known = PhoneCamera(CameraModel::kRadial);
  EXPECT_THAT(Validate(problem, CameraModel::kRadial).problem, HasSubstr("given"));
}

TEST(ModelChoice, FindsTheModelThatWasUsed) {
  for (const auto model :
       {CameraModel::kSimpleRadial, CameraModel::kRadial, CameraModel::kOpenCv}) {
    Camera camera = PhoneCamera(model);
    if (model == CameraModel::kOpenCv) camera.parameters[6] = 2e-3;
    const ModelChoice choice = ChooseModel(MakeScene(camera, {}).problem, {});
    EXPECT_EQ(CameraModelName(choice.model), CameraModelName(model)) << choice.reason;
    ASSERT_EQ(choice.trials.size(), 4u);
    EXPECT_GT(choice.trials[3].held_out_rms_px, 0.15);
  }
}

TEST(ModelChoice, KeepsTheGivenModelWhereNoneCanBeJudged) {
  SceneSettings settings;
  settings.photos = 3;
  BundleOptions options;
  options.model = CameraModel::kRadial;
  options.hold = {"k2"};
  const ModelChoice choice =
      ChooseModel(MakeScene(PhoneCamera(CameraModel::kRadial), settings).problem, options);
  EXPECT_EQ(choice.model, CameraModel::kRadial);
  EXPECT_THAT(choice.reason, HasSubstr("could be cross-validated"));
}

}  // namespace
}  // namespace glint
