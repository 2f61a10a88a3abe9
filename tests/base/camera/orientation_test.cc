#include "base/camera/orientation.h"

#include <gtest/gtest.h>

#include "tests/calib/testing/synthetic_photo.h"

namespace glint {
namespace {

// Every parameter differs from every other and from 0.
Camera CameraWithAllTerms(CameraModel model) {
  Camera camera{model, 4000, 3000, {}};
  const size_t focal_lengths = FocalLengthCount(model);
  for (size_t i = 0; i < CameraParameterNames(model).size(); ++i) {
    const auto k = static_cast<double>(i);
    const double term = (i % 2 == 0 ? 4e-3 : -6e-3) * k;
    camera.parameters.push_back(i < focal_lengths    ? 3100 + 105 * k
                                : IsLength(model, i) ? (i == focal_lengths ? 2011 : 1489)
                                                     : term);
  }
  return camera;
}

TEST(Orientation, ATurnedCameraOfEveryModelSeesTheTurnedPicture) {
  testing::Random random(3);
  for (const CameraModelInfo& info : kCameraModels) {
    const Camera camera = CameraWithAllTerms(info.model);
    for (int turns = -1; turns <= 4; ++turns) {
      for (int i = 0; i < 20; ++i) {
        const Eigen::Vector3d p(random.Uniform(-0.6, 0.6), random.Uniform(-0.4, 0.4), 1);
        const Eigen::Vector2d expected =
            TurnedImagePoint(ImageFromCamera(camera, p), 4000, 3000, turns);
        const Eigen::Vector2d seen =
            ImageFromCamera(TurnedCamera(camera, turns), TurnedCameraPoint(p, turns));
        EXPECT_LT((seen - expected).norm(), 1e-9) << info.name << " " << turns;
      }
    }
  }
}

// EXIF 6: the stored picture's left column becomes the upright one's top row, read from below.
TEST(Orientation, FollowsExif) {
  EXPECT_EQ(QuarterTurns(1), 0);
  EXPECT_EQ(QuarterTurns(6), 1);
  EXPECT_EQ(QuarterTurns(3), 2);
  EXPECT_EQ(QuarterTurns(8), 3);
  EXPECT_FALSE(QuarterTurns(2));
  EXPECT_EQ(TurnedImagePoint({0.5, 2999.5}, 4000, 3000, 1), Eigen::Vector2d(0.5, 0.5));
  EXPECT_EQ(TurnedImagePoint({0.5, 0.5}, 4000, 3000, 1), Eigen::Vector2d(2999.5, 0.5));
  EXPECT_EQ(TurnedImagePoint({0.5, 0.5}, 4000, 3000, 2), Eigen::Vector2d(3999.5, 2999.5));
}

TEST(Orientation, PosesTurnWithTheCamera) {
  const Rigid3 pose = testing::LookAt(300, 20, 30, 40);
  const Eigen::Vector3d point(10, -20, 0);
  for (int turns = 0; turns < 4; ++turns) {
    EXPECT_TRUE((TurnedPose(pose, turns) * point).isApprox(TurnedCameraPoint(pose * point, turns)));
    EXPECT_NEAR(TurnedPose(pose, turns).rotation.determinant(), 1, 1e-12);
  }
}

}  // namespace
}  // namespace glint
