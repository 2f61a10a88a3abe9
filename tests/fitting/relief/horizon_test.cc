// What a relief hides from a light, and how surely.
#include "fitting/relief/horizon.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace glint {
namespace {

constexpr int kWidth = 64, kHeight = 48;
constexpr double kTexel_mm = 2, kWall_mm = 10;

SamplePlane Plane() {
  SamplePlane plane;
  plane.width = kWidth;
  plane.height = kHeight;
  plane.width_mm = kTexel_mm * kWidth;
  plane.height_mm = kTexel_mm * kHeight;
  return plane;
}

HeightField Level() {
  return {kWidth, kHeight, kTexel_mm, kTexel_mm,
          std::vector<float>(static_cast<size_t>(kWidth) * kHeight, 0.0f)};
}

// A wall of one texel's thickness along a column.
HeightField Wall(int column) {
  HeightField field = Level();
  for (int row = 0; row < kHeight; ++row) {
    field.height_mm[static_cast<size_t>(row) * kWidth + column] = kWall_mm;
  }
  return field;
}

// So far away that it is the same direction everywhere.
Vec3d Light(double azimuth_deg, double elevation_deg) {
  const double azimuth = azimuth_deg * std::numbers::pi / 180;
  const double elevation = elevation_deg * std::numbers::pi / 180;
  return {1e7 * std::cos(azimuth) * std::cos(elevation),
          1e7 * std::sin(azimuth) * std::cos(elevation), 1e7 * std::sin(elevation)};
}

double ShareAt(const Horizon& horizon, int column, int row, const Vec3d& light) {
  const SamplePlane plane = Plane();
  return horizon.HiddenShare(plane.x_mm(column), plane.y_mm(row), light);
}

TEST(Horizon, WallHidesWhatLiesBehindItAsFarAsItsShadowReaches) {
  const Horizon horizon(Wall(40), Plane());
  const double elevation_deg = 30;
  const double reach = kWall_mm / kTexel_mm / std::tan(elevation_deg * std::numbers::pi / 180);
  for (int column = 0; column < kWidth; ++column) {
    const double share = ShareAt(horizon, column, 20, Light(0, elevation_deg));
    const double behind = 40 - column;
    if (behind > 0.5 && behind < reach - 1) {
      EXPECT_GT(share, 0.99) << column;
    } else if (behind < 0 || behind > reach + 1) {
      EXPECT_LT(share, 0.01) << column;
    }
  }
}

TEST(Horizon, WhereTheShadowEndsNothingIsSure) {
  const Horizon horizon(Wall(40), Plane());
  const Vec3d light = Light(0, std::atan(0.5) * 180 / std::numbers::pi);  // 10 texels long
  EXPECT_NEAR(ShareAt(horizon, 30, 20, light), 0.5, 0.01);
}

TEST(Horizon, LightFromTheTopHidesWhatLiesBelow) {
  HeightField field = Level();
  for (int column = 0; column < kWidth; ++column) {
    field.height_mm[static_cast<size_t>(20) * kWidth + column] = kWall_mm;
  }
  const Horizon horizon(field, Plane());
  EXPECT_GT(ShareAt(horizon, 30, 23, Light(90, 30)), 0.99);
  EXPECT_LT(ShareAt(horizon, 30, 17, Light(90, 30)), 0.01);
  EXPECT_GT(ShareAt(horizon, 30, 17, Light(270, 30)), 0.99);
}

TEST(Horizon, DirectionsBetweenTheAxesMeetTheWallLater) {
  const Horizon horizon(Wall(40), Plane());
  // Along the diagonal the wall is √2 times as far: its shadow is √½ as deep.
  const Vec3d light = Light(45, std::atan(0.5) * 180 / std::numbers::pi);
  EXPECT_GT(ShareAt(horizon, 35, 30, light), 0.99);
  EXPECT_LT(ShareAt(horizon, 31, 30, light), 0.01);
}

TEST(Horizon, NearLightStandsHigherAboveWhatIsNear) {
  const Horizon horizon(Wall(40), Plane());
  const SamplePlane plane = Plane();
  const Vec3d light = {plane.x_mm(50), plane.y_mm(20), 40};
  EXPECT_GT(ShareAt(horizon, 38, 20, light), 0.99);  // 59° up; the wall's top 68°
  EXPECT_LT(ShareAt(horizon, 30, 20, light), 0.01);  // 45°; 27°
  EXPECT_EQ(ShareAt(horizon, 50, 20, light), 0);     // right above
}

TEST(Horizon, LevelSampleHidesNothingThatIsNotAtGrazingAngle) {
  const Horizon horizon(Level(), Plane());
  for (const double elevation : {15.0, 30.0, 80.0}) {
    EXPECT_LT(ShareAt(horizon, 30, 20, Light(70, elevation)), 1e-4) << elevation;
  }
  EXPECT_EQ(horizon.slope_variance(), 0);
}

// Of heights that are coarser than the texels, the first centre lies inside the first texels.
TEST(Horizon, HidesTexelsOutsideTheOutermostCentresToo) {
  const Horizon horizon(Wall(40), Plane());
  const double above_mm = Plane().y_mm(0) + 0.4 * kTexel_mm;
  EXPECT_GT(horizon.HiddenShare(Plane().x_mm(36), above_mm, Light(0, 30)), 0.99);
}

TEST(Horizon, SlopesAreThoseOfTheHeights) {
  HeightField field = Level();
  for (int row = 0; row < kHeight; ++row) {
    for (int column = 0; column < kWidth; ++column) {
      field.height_mm[static_cast<size_t>(row) * kWidth + column] =
          static_cast<float>(kTexel_mm * (0.3 * column - 0.1 * row));
    }
  }
  EXPECT_NEAR(Horizon(field, Plane()).slope_variance(), (0.09 + 0.01) / 2, 1e-3);
}

}  // namespace
}  // namespace glint
