#include "calib/colmap/plane.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <random>

namespace glint {
namespace {

using Eigen::Vector3d;
using ::testing::HasSubstr;

std::mt19937 generator(7);
double Unit() { return 2 * (generator() / 4294967296.0) - 1; }

Vector3d Scattered() { return {2 * Unit(), 2 * Unit(), 2 * Unit()}; }

// On the plane x + 2y − 2z = 3, noise of 0.002.
Vector3d OnPlane() {
  const Vector3d normal = Vector3d(1, 2, -2) / 3;
  const Vector3d a = normal.unitOrthogonal(), b = normal.cross(a);
  return normal * (1 + 0.002 * Unit()) + 2 * Unit() * a + 1.5 * Unit() * b;
}

PlaneOptions Options() {
  PlaneOptions options;
  options.threshold = 0.02;
  return options;
}

TEST(FitPlane, FindsThePlaneAmongAsManyOutliers) {
  std::vector<CloudPoint> points;
  for (int i = 0; i < 400; ++i) points.push_back({i % 2 ? OnPlane() : Scattered(), 1});
  const PlaneFit plane = FitPlane(points, Options());
  ASSERT_EQ(plane.problem, "");
  EXPECT_GT(std::abs(plane.normal.dot(Vector3d(1, 2, -2) / 3)), std::cos(0.05 * M_PI / 180));
  EXPECT_NEAR(std::abs(plane.offset), 1, 1e-3);
  EXPECT_NEAR(plane.share, 0.5, 0.03);
  EXPECT_LT(plane.rms, 0.005);
}

TEST(FitPlane, WeightsDecideBetweenTwoPlanes) {
  std::vector<CloudPoint> points;
  for (int i = 0; i < 300; ++i) points.push_back({Vector3d(Unit(), Unit(), 0), 1});
  for (int i = 0; i < 100; ++i) points.push_back({Vector3d(Unit(), 0.5, Unit()), 6});
  const PlaneFit plane = FitPlane(points, Options());
  EXPECT_NEAR(std::abs(plane.normal.y()), 1, 1e-6);
}

TEST(FitPlane, TheSamePointsGiveTheSamePlane) {
  std::vector<CloudPoint> points;
  for (int i = 0; i < 200; ++i) points.push_back({i % 3 ? OnPlane() : Scattered(), 1});
  EXPECT_EQ(FitPlane(points, Options()).normal, FitPlane(points, Options()).normal);
}

TEST(FitPlane, SaysWhyThereIsNone) {
  std::vector<CloudPoint> scattered, line, few;
  for (int i = 0; i < 500; ++i) scattered.push_back({Scattered(), 1});
  for (int i = 0; i < 500; ++i) {
    line.push_back({Vector3d(Unit(), 0, 0) + 0.004 * Vector3d(Unit(), Unit(), Unit()), 1});
  }
  for (int i = 0; i < 5; ++i) few.push_back({OnPlane(), 1});
  EXPECT_THAT(FitPlane(scattered, Options()).problem, HasSubstr("scattered"));
  EXPECT_THAT(FitPlane(line, Options()).problem, HasSubstr("line"));
  EXPECT_THAT(FitPlane(few, Options()).problem, HasSubstr("only 5 points"));
  EXPECT_NE(FitPlane({}, Options()).problem, "");
}

}  // namespace
}  // namespace glint
