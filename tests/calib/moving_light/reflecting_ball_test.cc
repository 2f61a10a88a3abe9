#include "calib/moving_light/reflecting_ball.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace glint {
namespace {

constexpr double kDegree_rad = std::numbers::pi / 180;

Eigen::Vector3d LightFrom(double elevation_deg, double azimuth_deg) {
  const double side = std::cos(elevation_deg * kDegree_rad);
  return {side * std::cos(azimuth_deg * kDegree_rad), side * std::sin(azimuth_deg * kDegree_rad),
          std::sin(elevation_deg * kDegree_rad)};
}

// A black ball that mirrors a lamp of a few degrees' width, cut out of a larger picture.
BallPicture Photograph(const BallOutline& ball, const Eigen::Vector3d& light, float ambient) {
  constexpr double kSharpness = 800;
  BallPicture picture;
  picture.left_px = static_cast<int>(ball.centre_px.x() - ball.radius_px) - 3;
  picture.top_px = static_cast<int>(ball.centre_px.y() - ball.radius_px) - 2;
  picture.width = static_cast<int>(2 * ball.radius_px) + 8;
  picture.height = static_cast<int>(2 * ball.radius_px) + 6;
  for (int row = 0; row < picture.height; ++row) {
    for (int column = 0; column < picture.width; ++column) {
      const double x = (picture.left_px + column + 0.5 - ball.centre_px.x()) / ball.radius_px;
      const double y = -(picture.top_px + row + 0.5 - ball.centre_px.y()) / ball.radius_px;
      const double square = x * x + y * y;
      float value = ambient;
      if (square < 1) {
        const Eigen::Vector3d normal(x, y, std::sqrt(1 - square));
        const Eigen::Vector3d mirrored = 2 * normal.z() * normal - Eigen::Vector3d(0, 0, 1);
        value += static_cast<float>(std::exp(kSharpness * (mirrored.dot(light) - 1)));
      }
      picture.brightness.push_back(value);
    }
  }
  return picture;
}

TEST(CircleThrough, FindsTheCircleOfThreePointsOfItsRim) {
  const Eigen::Vector2d centre(310.5, 204.25);
  const auto rim = [&](double angle) -> Eigen::Vector2d {
    return centre + 57.5 * Eigen::Vector2d(std::cos(angle), std::sin(angle));
  };
  const auto ball = CircleThrough({rim(0.3), rim(2.1), rim(5.0)});
  ASSERT_TRUE(ball);
  EXPECT_LT((ball->centre_px - centre).norm(), 1e-9);
  EXPECT_NEAR(ball->radius_px, 57.5, 1e-9);
}

TEST(CircleThrough, PointsOnALineHaveNone) {
  using Eigen::Vector2d;
  EXPECT_FALSE(CircleThrough({Vector2d(0, 0), Vector2d(1, 2), Vector2d(3, 6)}));
  EXPECT_FALSE(CircleThrough({Vector2d(5, 5), Vector2d(5, 5), Vector2d(9, 1)}));
  EXPECT_FALSE(CircleThrough({Vector2d(5, 5), Vector2d(5, 5), Vector2d(5, 5)}));
}

TEST(LightFromBall, FindsTheLightOfAReflection) {
  const BallOutline ball{{120.3, 80.8}, 45.5};
  for (const double elevation : {10.0, 30.0, 55.0, 80.0}) {
    for (const double azimuth : {0.0, 75.0, 160.0, 290.0}) {
      const Eigen::Vector3d light = LightFrom(elevation, azimuth);
      const auto found = LightFromBall(Photograph(ball, light, 0.02f), ball);
      ASSERT_TRUE(found) << elevation << " " << azimuth;
      EXPECT_NEAR(found->norm(), 1, 1e-9);
      EXPECT_LT(std::acos(std::min(1.0, found->dot(light))) / kDegree_rad, 1)
          << elevation << " " << azimuth;
    }
  }
}

TEST(LightFromBall, UpInThePictureIsUp) {
  const BallOutline ball{{50, 50}, 40};
  BallPicture picture{0, 0, 100, 100, std::vector<float>(10000, 0.01f)};
  picture.brightness[30 * 100 + 49] = picture.brightness[30 * 100 + 50] = 1;  // above the middle
  const auto found = LightFromBall(picture, ball);
  ASSERT_TRUE(found);
  EXPECT_GT(found->y(), 0.5);
  EXPECT_NEAR(found->x(), 0, 1e-6);
}

TEST(LightFromBall, BrightPlacesBesideTheBallAndAtItsRimAreNoReflections) {
  const BallOutline ball{{60, 60}, 40};
  const Eigen::Vector3d light = LightFrom(60, 30);
  BallPicture picture = Photograph(ball, light, 0.02f);
  const int middle = picture.height / 2;
  for (int column = 0; column < 8; ++column) {  // the table left of the ball, and mirrored by it
    picture.brightness[static_cast<size_t>(middle) * picture.width + column] = 5;
  }
  const auto found = LightFromBall(picture, ball);
  ASSERT_TRUE(found);
  EXPECT_GT(found->dot(light), std::cos(kDegree_rad));
}

TEST(LightFromBall, BallWithoutAReflectionTellsNothing) {
  const BallOutline ball{{50, 50}, 40};
  EXPECT_FALSE(LightFromBall({0, 0, 100, 100, std::vector<float>(10000, 0.1f)}, ball));
  EXPECT_FALSE(LightFromBall({0, 0, 100, 100, std::vector<float>(10000, 0.0f)}, ball));
  EXPECT_FALSE(LightFromBall({0, 0, 0, 0, {}}, ball));
}

}  // namespace
}  // namespace glint
