#include "fitting/tiling/tile_maps.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>

#include "datasets/procedural/material.h"
#include "fitting/relief/height_field.h"
#include "fitting/relief/torus_poisson.h"
#include "fitting/tiling/seam.h"

namespace glint {
namespace {

SvbrdfMaps Material(const char* family, int size) { return MakeMaterial(family, 5, size, size); }

// Bricks of 30 × 20 texels, each row shifted by half a brick: periods 30 and 40. With grain, as
// large in the joints as on the bricks unless stated.
SvbrdfMaps Bricks(int size, float bricks_grain = 1) {
  SvbrdfMaps maps(size, size);
  std::mt19937 random(3);
  std::uniform_real_distribution<float> grain(-0.01f, 0.01f);
  for (int row = 0; row < size; ++row) {
    for (int column = 0; column < size; ++column) {
      const int shifted = column + ((row / 20) % 2) * 15;
      const bool joint = row % 20 < 3 || shifted % 30 < 3;
      for (int c = 0; c < 3; ++c) {
        maps.at(kDiffuseR + c, row, column) =
            (joint ? 0.2f + grain(random) : 0.5f - 0.1f * c + bricks_grain * grain(random));
        maps.at(kSpecularR + c, row, column) = 0.04f;
      }
      maps.at(kRoughness, row, column) = joint ? 0.8f : 0.5f;
      maps.at(kNormalZ, row, column) = 1;
    }
  }
  return maps;
}

TEST(CheapestPath, IsThatOfBruteForce) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> uniform(0, 1);
  constexpr int kSteps = 7, kDepth = 3;
  for (int trial = 0; trial < 20; ++trial) {
    std::vector<double> costs(kSteps * kDepth);
    for (double& cost : costs) cost = uniform(random);
    for (const bool cyclic : {false, true}) {
      double least = std::numeric_limits<double>::infinity();
      for (int code = 0; code < std::pow(kDepth, kSteps); ++code) {
        int rest = code, positions[kSteps];
        double sum = 0;
        for (int step = 0; step < kSteps; ++step, rest /= kDepth) {
          positions[step] = rest % kDepth;
          sum += costs[static_cast<size_t>(step) * kDepth + positions[step]];
        }
        bool allowed = !cyclic || std::abs(positions[0] - positions[kSteps - 1]) <= 1;
        for (int step = 1; step < kSteps; ++step) {
          allowed &= std::abs(positions[step] - positions[step - 1]) <= 1;
        }
        if (allowed) least = std::min(least, sum);
      }
      const auto path = CheapestPath(kSteps, kDepth, cyclic, [&](int step, int position) {
        return costs[static_cast<size_t>(step) * kDepth + position];
      });
      double sum = 0;
      for (int step = 0; step < kSteps; ++step) {
        sum += costs[static_cast<size_t>(step) * kDepth + path[static_cast<size_t>(step)]];
      }
      EXPECT_NEAR(sum, least, 1e-12) << trial << cyclic;
    }
  }
}

TEST(TorusPoisson, FindsValuesFromTheirDifferences) {
  constexpr int kWidth = 15, kHeight = 8;
  std::mt19937 random(2);
  std::normal_distribution<double> normal;
  std::vector<double> values(kWidth * kHeight), across, down;
  for (double& value : values) value = normal(random);
  for (int row = 0; row < kHeight; ++row) {
    for (int column = 0; column < kWidth; ++column) {
      const auto at = [&](int r, int c) {
        return values[static_cast<size_t>(r % kHeight) * kWidth + c % kWidth];
      };
      across.push_back(at(row, column + 1) - at(row, column));
      down.push_back(at(row + 1, column) - at(row, column));
    }
  }
  const auto solved = SolveTorusPoisson(kWidth, kHeight, across, down, values, 0.3);
  for (size_t i = 0; i < values.size(); ++i) EXPECT_NEAR(solved[i], values[i], 1e-10);
}

TEST(BestInterval, IsAMultipleOfThePeriod) {
  const EncodedMaps maps = EncodeMaps(Bricks(200));
  const Interval across = BestInterval(maps, true, 70, 24);
  const Interval down = BestInterval(maps, false, 70, 24);
  EXPECT_EQ(across.length % 30, 0) << across.length;
  EXPECT_EQ(down.length % 40, 0) << down.length;
  EXPECT_LE(across.begin + across.length + 24, 200);
}

TEST(TileMaps, SeamsCannotBeToldFromTheTexture) {
  for (const char* family : {"leather", "wood", "stone"}) {
    const TileResult result = TileMaps(Material(family, 160), {}, 2);
    EXPECT_LT(result.seam.worst(), 1.1) << family;
    EXPECT_GE(result.maps.width, 64) << family;
  }
}

// Copies agree best in the joints, whose texels differ most from their neighbours.
TEST(TileMaps, SeamsDoNotFollowTheJointsOfAFloor) {
  const TileResult result = TileMaps(Bricks(200, 6), {}, 2);
  EXPECT_LT(result.seam.worst(), 1.1);
}

// In the encoding, in which maps are joined.
TEST(TileMaps, EveryMapKeepsItsMeanAndSpread) {
  const SvbrdfMaps maps = Material("leather", 160);
  TileOptions options;
  options.flatten = 0;  // which takes its share of the spread
  const auto moments = [](const EncodedMaps& of, int plane) {
    const size_t texels = static_cast<size_t>(of.width) * of.height;
    double mean = 0, square = 0;
    for (size_t i = 0; i < texels; ++i) {
      const double value = of.planes[plane * texels + i];
      mean += value;
      square += value * value;
    }
    mean /= static_cast<double>(texels);
    return std::pair(mean,
                     std::sqrt(std::max(0.0, square / static_cast<double>(texels) - mean * mean)));
  };
  const EncodedMaps before = EncodeMaps(maps);
  const EncodedMaps after = EncodeMaps(TileMaps(maps, options, 1).maps);
  for (int plane = 0; plane < kEncodedChannels; ++plane) {
    const auto [mean, spread] = moments(before, plane);
    const auto [tile_mean, tile_spread] = moments(after, plane);
    EXPECT_NEAR(tile_mean, mean, 0.01) << plane;
    EXPECT_NEAR(tile_spread, spread, 0.02 * spread + 1e-4) << plane;
  }
}

TEST(TileMaps, SlowChangesAreTakenOutAndCanBeKept) {
  SvbrdfMaps maps = Material("leather", 160);
  for (int row = 0; row < 160; ++row) {
    for (int column = 0; column < 160; ++column) {
      for (int c = 0; c < 3; ++c) {
        maps.at(kDiffuseR + c, row, column) *= 0.6f + 0.8f * column / 160;
      }
    }
  }
  const auto slope = [](const SvbrdfMaps& tile) {  // right half over left half
    double left = 0, right = 0;
    for (int row = 0; row < tile.height; ++row) {
      for (int column = 0; column < tile.width; ++column) {
        const float value = tile.plane(kDiffuseG)[static_cast<size_t>(row) * tile.width + column];
        (2 * column < tile.width ? left : right) += value;
      }
    }
    return right / left;
  };
  TileOptions keep;
  keep.flatten = 0;
  EXPECT_NEAR(slope(TileMaps(maps, {}, 1).maps), 1, 0.03);
  EXPECT_GT(slope(TileMaps(maps, keep, 1).maps), 1.06);
}

// Tents of half a side, two of them, follow the middle half of a ramp: by their integrals .393 of
// the difference between the ramp's halves is left. Roughness is encoded linearly.
TEST(FlattenMaps, LeavesOfARampWhatTwoTentsDoNotFollow) {
  SvbrdfMaps ramp = Material("leather", 160);
  for (int row = 0; row < 160; ++row) {
    for (int column = 0; column < 160; ++column) {
      ramp.at(kRoughness, row, column) = 0.3f + 0.4f * (static_cast<float>(column) + 0.5f) / 160;
    }
  }
  const auto difference = [](const SvbrdfMaps& of) {  // of the means of right and left half
    double sum = 0;
    for (int row = 0; row < 160; ++row) {
      for (int column = 0; column < 160; ++column) {
        sum += (column < 80 ? -1 : 1) * of.at(kRoughness, row, column);
      }
    }
    return sum / (80.0 * 160);
  };
  ASSERT_NEAR(difference(ramp), 0.2, 1e-3);
  EXPECT_NEAR(difference(FlattenMaps(ramp, {})), 0.393 * 0.2, 1e-3);
  TileOptions none;
  none.flatten = 0;
  EXPECT_NEAR(difference(FlattenMaps(ramp, none)), 0.2, 1e-3);
}

TEST(TileMaps, BitsDoNotDependOnThreadsAndSmallMapsAreRefused) {
  const SvbrdfMaps maps = Material("wood", 96);
  EXPECT_EQ(TileMaps(maps, {}, 1).maps.planes, TileMaps(maps, {}, 3).maps.planes);
  EXPECT_THROW(TileMaps(Material("wood", 31), {}, 1), std::invalid_argument);
}

TEST(RepeatingHeights, MeetTheirNormalsAcrossTheBorder) {
  constexpr int kSize = 64;
  const SamplePlane plane{kSize, kSize, 64, 64};
  HeightField truth{kSize, kSize, 1, 1, std::vector<float>(kSize * kSize), true};
  SvbrdfMaps maps(kSize, kSize);
  const double wave = 2 * std::numbers::pi / kSize;
  for (int row = 0; row < kSize; ++row) {
    for (int column = 0; column < kSize; ++column) {
      const double x = wave * (column + 9), y = wave * (row + 5);
      truth.height_mm[static_cast<size_t>(row) * kSize + column] =
          static_cast<float>(2 * std::sin(x) + std::cos(2 * y));
      const double slope_x = 2 * wave * std::cos(x), slope_down = -2 * wave * std::sin(2 * y);
      const double length = std::sqrt(1 + slope_x * slope_x + slope_down * slope_down);
      maps.at(kNormalX, row, column) = static_cast<float>(-slope_x / length);
      maps.at(kNormalY, row, column) = static_cast<float>(slope_down / length);
      maps.at(kNormalZ, row, column) = static_cast<float>(1 / length);
    }
  }
  const HeightField found = IntegrateRepeatingNormals(maps, plane);
  double worst = 0;
  for (size_t i = 0; i < found.height_mm.size(); ++i) {
    worst = std::max<double>(worst, std::abs(found.height_mm[i] - truth.height_mm[i]));
  }
  EXPECT_LT(worst, 0.03);  // of a range of 6
  EXPECT_NEAR(found.Lookup(-1, kSize + 2), found.at(kSize - 1, 2), 1e-6);
  EXPECT_NEAR(found.Lookup(3, -0.5), 0.5 * (found.at(3, kSize - 1) + found.at(3, 0)), 1e-6);
}

}  // namespace
}  // namespace glint
