#include "calib/bundle/bundle.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "base/board/board.h"
#include "base/errors/errors.h"
#include "calib/bundle/residual_picture.h"
#include "tests/calib/testing/board_scene.h"

namespace glint {
namespace {

using testing::FrameBoard;
using ::testing::HasSubstr;
using testing::Random;
using testing::Scene;

Camera Phone(CameraModel model) { return testing::PhoneCamera(model); }

Scene MakeScene(const Camera& camera, int photos, double noise_px, std::uint64_t seed,
                double tilt_scale = 1) {
  testing::SceneSettings settings;
  settings.photos = photos;
  settings.noise_px = noise_px;
  settings.seed = seed;
  settings.tilt_scale = tilt_scale;
  return testing::MakeScene(camera, settings);
}

class Models : public ::testing::TestWithParam<CameraModel> {};

// Every parameter within 4σ of the truth, σ by the result itself: over all models about 150
// numbers.
TEST_P(Models, AreRecoveredWithinTheirOwnUncertainty) {
  const Camera truth = Phone(GetParam());
  const Scene scene = MakeScene(truth, 12, 0.15, 3);
  BundleOptions options;
  options.model = GetParam();
  const BundleResult result = AdjustBundle(scene.problem, options);
  EXPECT_NEAR(result.rms_px, 0.15 * std::sqrt(2.0), 0.01);
  const CameraEstimate& estimate = result.cameras[0];
  const auto& names = CameraParameterNames(GetParam());
  double squares = 0;
  for (size_t i = 0; i < names.size(); ++i) {
    ASSERT_GT(estimate.sigma[i], 0) << names[i];
    const double deviation =
        (estimate.camera.parameters[i] - truth.parameters[i]) / estimate.sigma[i];
    EXPECT_LE(std::abs(deviation), 4)
        << names[i] << " " << estimate.camera.parameters[i] << " ± " << estimate.sigma[i];
    squares += deviation * deviation;
  }
  EXPECT_LT(squares / names.size(), 4);
  if (GetParam() != CameraModel::kFullOpenCv) {
    EXPECT_LT(std::abs(estimate.camera.parameters[0] / truth.parameters[0] - 1), 0.002);
  }
  for (size_t i = 0; i < scene.poses.size(); ++i) {
    const Eigen::Vector3d position = Inverse(scene.poses[i]).translation;
    const PhotoEstimate& photo = result.photos[i];
    const double error = (Inverse(photo.camera_from_sample).translation - position).norm();
    EXPECT_LE(error, 4 * std::sqrt(3.0) * photo.sigma_position_mm) << i;
    EXPECT_NEAR(photo.tilt_deg, 5 + 3.0 * i, 0.5);
  }
}
INSTANTIATE_TEST_SUITE_P(All, Models, ::testing::ValuesIn(CalibratedModels(Calibrated::kOnDemand)));

// σ is what repetition shows: the spread of the focal length over 120 draws of the noise.
TEST(AdjustBundle, SigmaIsTheSpreadOverRepetitions) {
  const Camera truth = Phone(CameraModel::kRadial);
  BundleOptions options;
  options.model = CameraModel::kRadial;
  double sum = 0, squares = 0, sigma = 0;
  constexpr int kDraws = 120;
  options.reject = false;
  for (int draw = 0; draw < kDraws; ++draw) {
    const auto result = AdjustBundle(MakeScene(truth, 5, 0.2, 100 + draw).problem, options);
    const double f = result.cameras[0].camera.parameters[0] - 3100;
    sum += f;
    squares += f * f;
    sigma += result.cameras[0].sigma[0] / kDraws;
  }
  const double spread = std::sqrt((squares - sum * sum / kDraws) / (kDraws - 1));
  EXPECT_NEAR(spread / sigma, 1, 0.2);  // 3 standard deviations of the ratio
  EXPECT_LE(std::abs(sum / kDraws), 3.5 * sigma / std::sqrt(kDraws));
}

TEST(AdjustBundle, RejectsAndNamesOutlierCornersAndPhotos) {
  const Camera truth = Phone(CameraModel::kOpenCv);
  Scene scene = MakeScene(truth, 10, 0.1, 8);
  Random random(4);
  for (int i = 0; i < 10; ++i) {
    auto& corners = scene.problem.photos[i].corners;
    corners[3 * i].point_px += Eigen::Vector2d(6, -4);
    corners[3 * i + 1].point_px += Eigen::Vector2d(-3, 200);
  }
  // A photo whose board was bent, moved or blurred: all corners off by some pixels.
  for (auto& corner : scene.problem.photos[4].corners) {
    corner.point_px += Eigen::Vector2d(random.Uniform(-9, 9), random.Uniform(-9, 9));
  }
  // And one of the corners in another order.
  std::reverse(scene.problem.photos[7].corners.begin(), scene.problem.photos[7].corners.end());
  for (size_t k = 0; k < scene.problem.photos[7].corners.size(); ++k) {
    scene.problem.photos[7].corners[k].position_in_sample_mm =
        BoardCorners(FrameBoard())[k * 7 % 72].position_in_sample_mm;
  }
  const BundleResult result = AdjustBundle(scene.problem);
  for (int i = 0; i < 10; ++i) {
    const PhotoEstimate& photo = result.photos[i];
    EXPECT_EQ(photo.rejected.empty(), i != 4 && i != 7) << photo.name << ": " << photo.rejected;
    if (!photo.rejected.empty()) continue;
    EXPECT_FALSE(photo.corners[3 * i].inlier);
    EXPECT_FALSE(photo.corners[3 * i + 1].inlier);
    EXPECT_EQ(photo.inliers(), static_cast<int>(photo.corners.size()) - 2);
  }
  EXPECT_LE(std::abs(result.cameras[0].camera.parameters[0] - 3100),
            4 * result.cameras[0].sigma[0]);
  EXPECT_LT(result.rms_px, 0.16);
}

TEST(AdjustBundle, RefusesPhotosThatAllLookStraightDown) {
  for (const double noise_px : {0.0, 0.1}) {
    const Scene scene = MakeScene(Phone(CameraModel::kRadial), 8, noise_px, 1, 0);
    try {
      AdjustBundle(scene.problem);
      FAIL() << "not refused";
    } catch (const UserError& error) {
      EXPECT_THAT(error.what(), HasSubstr("tilt the phone"));
      EXPECT_THAT(error.what(), HasSubstr("8 photographs"));
    }
  }
  // With known intrinsics the poses are determined all the same.
  Scene scene = MakeScene(Phone(CameraModel::kRadial), 8, 0.1, 1, 0);
  scene.problem.cameras[0].known = Phone(CameraModel::kRadial);
  BundleOptions options;
  options.model = CameraModel::kRadial;
  const auto result = AdjustBundle(scene.problem, options);
  for (int i = 0; i < 8; ++i) {
    EXPECT_LT((Inverse(result.photos[i].camera_from_sample).translation -
               Inverse(scene.poses[i]).translation)
                  .norm(),
              0.5);
  }
  EXPECT_EQ(result.cameras[0].camera.parameters, Phone(CameraModel::kRadial).parameters);
}

TEST(AdjustBundle, SolvesSeveralCamerasAtOnce) {
  const Camera wide = Phone(CameraModel::kRadial);
  Camera tele = wide;
  tele.parameters[0] = 5200;
  Scene a = MakeScene(wide, 6, 0.1, 1), b = MakeScene(tele, 6, 0.1, 2);
  a.problem.cameras.push_back(b.problem.cameras[0]);
  for (BundlePhoto photo : b.problem.photos) {
    photo.camera = 1;
    a.problem.photos.push_back(photo);
  }
  BundleOptions options;
  options.model = CameraModel::kRadial;
  const auto result = AdjustBundle(a.problem, options);
  EXPECT_NEAR(result.cameras[0].camera.parameters[0], 3100, 4 * result.cameras[0].sigma[0]);
  EXPECT_NEAR(result.cameras[1].camera.parameters[0], 5200, 4 * result.cameras[1].sigma[0]);
}

TEST(AdjustBundle, HoldsWhatItIsToldTo) {
  const Scene scene = MakeScene(Phone(CameraModel::kRadial), 8, 0.1, 1);
  BundleOptions options;
  options.hold = {"p1", "p2"};
  const auto result = AdjustBundle(scene.problem, options);
  EXPECT_EQ(result.cameras[0].camera.parameters[6], 0);
  EXPECT_EQ(result.cameras[0].sigma[7], 0);
  EXPECT_NEAR(result.cameras[0].camera.parameters[4], 0.06, 4 * result.cameras[0].sigma[4]);
  options.hold = {"f"};
  EXPECT_THROW(AdjustBundle(scene.problem, options), UserError);
}

TEST(AdjustBundle, RefusesTooFewCorners) {
  EXPECT_THROW(AdjustBundle({}, {}), UserError);
  Scene scene = MakeScene(Phone(CameraModel::kRadial), 2, 0.1, 1);
  for (auto& photo : scene.problem.photos) photo.corners.resize(3);
  try {
    AdjustBundle(scene.problem);
    FAIL() << "not refused";
  } catch (const ComputationError& error) {
    EXPECT_THAT(error.what(), HasSubstr("photo1.jpg"));
  }
}

TEST(ResidualPicture, ShowsEveryPhotoInItsColour) {
  const auto result = AdjustBundle(MakeScene(Phone(CameraModel::kOpenCv), 4, 0.1, 1).problem);
  const Image picture = ResidualPicture(result, 0, 400);
  EXPECT_EQ(picture.width, 400);
  EXPECT_GT(picture.height, 300);
  int ink = 0;
  for (const float value : picture.channel(0)) ink += value < 0.9f;
  EXPECT_GT(ink, 1000);
}

}  // namespace
}  // namespace glint
