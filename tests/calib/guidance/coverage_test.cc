#include "calib/guidance/coverage.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/calib/guidance/photo_fixture.h"

namespace glint {
namespace {

using testing::PhotoFrom;

constexpr double kDegree = std::numbers::pi / 180;

TEST(HalfAngle, IsZeroAtTheMirrorPointAndTheTiltWhereLightAndCameraAreOne) {
  // Camera and light at equal heights: the mirror point is half way between their feet.
  EXPECT_NEAR(HalfAngle_deg({-40, 10, 300}, {60, 10, 300}, {10, 10}), 0, 1e-9);
  EXPECT_NEAR(HalfAngle_deg({50, 0, 300}, {50, 0, 300}, {0, 0}), std::atan2(50, 300) / kDegree,
              1e-9);
  EXPECT_EQ(HalfAngle_deg({0, 0, 300}, {0, 0, -1}, {0, 0}), 180);
}

TEST(Coverage, OneTopViewShowsHighlightsInADisc) {
  GuidancePhoto photo;
  photo.camera_in_sample_mm = photo.light_in_sample_mm = {0, 0, 300};
  const Coverage coverage = ComputeCoverage(MakeCoverageGrid({100, 100}, 100), {photo});
  const double radius_mm = 300 * std::tan(8 * kDegree);
  EXPECT_NEAR(coverage.HighlightShare(8), std::numbers::pi * radius_mm * radius_mm / 1e4, 0.004);
  EXPECT_EQ(coverage.ShownShare(), 1);
}

TEST(Coverage, CellsBesideThePictureHaveNoPhoto) {
  // Looks 80 mm to the right of the sample: half a picture is 100 mm wide there.
  GuidancePhoto photo = PhotoFrom(150, 0, 0);
  photo.posed->camera_from_sample = testing::LookAt(150, 0, 0, 0, {80, 0});
  const double half_width_mm = 150 * 2000 / 3000.0;
  const CoverageGrid grid = MakeCoverageGrid({100, 40}, 50);
  EXPECT_EQ(grid.rows, 20);
  const Coverage coverage = ComputeCoverage(grid, {photo});
  // From x = 80 − 100 on; distortion moves the border by a few per cent.
  EXPECT_NEAR(coverage.ShownShare(), (50 - (80 - half_width_mm)) / 100, 0.05);
  EXPECT_EQ(coverage.photos[0], 0);
  EXPECT_TRUE(std::isinf(coverage.least_half_angle_deg[0]));
  EXPECT_EQ(coverage.photos[grid.columns - 1], 1);
  EXPECT_NEAR(ShownShare(photo, grid), coverage.ShownShare(), 1e-12);
}

TEST(Coverage, APointFarOutsideIsNotFoldedBackByTheDistortion) {
  GuidancePhoto photo = PhotoFrom(300, 0, 0);
  photo.posed->camera.parameters = {3000, 2000, 1500, -0.2, 0};  // turns back at r = 1.3
  EXPECT_TRUE(ShowsPoint(photo, {20, 20}));
  for (double x = 250; x < 1500; x += 10) EXPECT_FALSE(ShowsPoint(photo, {x, 0})) << x;
}

TEST(Coverage, RowsRunFromTheTop) {
  const CoverageGrid grid = MakeCoverageGrid({90, 60}, 3);
  EXPECT_EQ(grid.columns, 3);
  EXPECT_EQ(grid.rows, 2);
  EXPECT_TRUE(grid.Centre_mm(0).isApprox(Eigen::Vector2d(-30, 15)));
  EXPECT_TRUE(grid.Centre_mm(5).isApprox(Eigen::Vector2d(30, -15)));
}

TEST(Coverage, PixelsPerMillimetreAreFocalLengthOverDistance) {
  EXPECT_NEAR(PixelsPerMm(PhotoFrom(300, 0, 0)), 10, 0.01);
  // Tilted, one direction shrinks by the cosine.
  EXPECT_NEAR(PixelsPerMm(PhotoFrom(300, 40, 70)), 10 * std::sqrt(std::cos(40 * kDegree)), 0.01);
  EXPECT_EQ(PixelsPerMm(GuidancePhoto()), 0);
}

TEST(Coverage, DirectionsAreTiltAndAzimuth) {
  const Direction direction = DirectionOf({0, -100, 100});
  EXPECT_NEAR(direction.tilt_deg, 45, 1e-12);
  EXPECT_NEAR(direction.azimuth_deg, 270, 1e-12);
}

}  // namespace
}  // namespace glint
