#include "fitting/relief/ambient_occlusion.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

namespace glint {
namespace {

constexpr double kPi = std::numbers::pi;

HeightField Bumps(int size, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> uniform(0, 1);
  HeightField field{size, size, 20.0 / size, 20.0 / size,
                    std::vector<float>(static_cast<size_t>(size) * size)};
  for (int bump = 0; bump < 40; ++bump) {
    const double x = size * uniform(random), y = size * uniform(random);
    const double radius = 2 + 6 * uniform(random), height = 1.5 * uniform(random);
    for (int row = 0; row < size; ++row) {
      for (int column = 0; column < size; ++column) {
        const double d = std::hypot(column - x, row - y) / radius;
        if (d < 1) {
          field.height_mm[static_cast<size_t>(row) * size + column] +=
              static_cast<float>(height * (1 - d * d));
        }
      }
    }
  }
  return field;
}

// Rays cast in cosine-distributed directions, in short steps, until they leave the relief's reach.
double RayCast(const HeightField& field, int row, int column, double reach_mm) {
  constexpr int kRays = 256;
  int open = 0;
  const double here = field.at(row, column);
  for (int ray = 0; ray < kRays; ++ray) {
    const double u = (ray % 16 + 0.5) / 16,
                 azimuth = 2 * kPi * (static_cast<double>(ray - ray % 16) / 16 + 0.5) / 16;
    const double tangent = std::sqrt((1 - u) / u);  // cos²(polar) = u
    bool hidden = false;
    for (double d = 0.1 * field.texel_x_mm; d < reach_mm && !hidden; d += 0.25 * field.texel_x_mm) {
      const double height = field.Lookup(row - d * std::sin(azimuth) / field.texel_y_mm,
                                         column + d * std::cos(azimuth) / field.texel_x_mm);
      hidden = height - here > d / tangent + 1e-9;
    }
    open += !hidden;
  }
  return static_cast<double>(open) / kRays;
}

TEST(AmbientOcclusion, AFlatReliefIsOpen) {
  const HeightField flat{16, 12, 1, 1, std::vector<float>(16 * 12, 0.0f)};
  for (const float open : AmbientOcclusion(flat, {}, 1)) EXPECT_EQ(open, 1.0f);
}

TEST(AmbientOcclusion, AtAHighWallHalfOfTheSkyIsHidden) {
  HeightField wall{64, 64, 1, 1, std::vector<float>(64 * 64, 0.0f)};
  for (int row = 0; row < 64; ++row) {
    for (int column = 0; column < 32; ++column) {
      wall.height_mm[static_cast<size_t>(row) * 64 + column] = 1000;
    }
  }
  OcclusionOptions options;
  options.directions = 64;
  EXPECT_NEAR(AmbientOcclusion(wall, options, 1)[32 * 64 + 32], 0.5, 0.02);
}

TEST(AmbientOcclusion, AgreesWithCastRays) {
  const HeightField field = Bumps(64, 3);
  OcclusionOptions options;
  options.reach_mm = 5;
  const std::vector<float> open = AmbientOcclusion(field, options, 2);
  double n = 0, x = 0, y = 0, xx = 0, yy = 0, xy = 0, off = 0;
  for (int row = 2; row < 64; row += 4) {
    for (int column = 2; column < 64; column += 4) {
      const double ours = open[static_cast<size_t>(row) * 64 + column];
      const double cast = RayCast(field, row, column, options.reach_mm);
      n += 1, x += ours, y += cast, xx += ours * ours, yy += cast * cast, xy += ours * cast;
      off += std::abs(ours - cast);
    }
  }
  const double correlation = (n * xy - x * y) / std::sqrt((n * xx - x * x) * (n * yy - y * y));
  EXPECT_GT(correlation, 0.95);
  EXPECT_LT(off / n, 0.03);
  EXPECT_LT(y / n, 0.95);  // there is something to see
}

// Each texel by itself, with Lookup: of a field that is not square, nor are its texels, and whose
// borders continue.
TEST(AmbientOcclusion, IsThatOfTexelsLookedUpOneByOne) {
  HeightField field{40, 26, 0.5, 0.7, std::vector<float>(40 * 26)};
  std::mt19937 random(9);
  std::uniform_real_distribution<float> uniform(0, 1);
  for (float& height : field.height_mm) height = uniform(random);
  OcclusionOptions options;
  options.directions = 6;
  options.reach_mm = 9;
  const std::vector<float> open = AmbientOcclusion(field, options, 1);
  for (int row = 0; row < field.height; ++row) {
    for (int column = 0; column < field.width; ++column) {
      double sum = 0;
      for (int i = 0; i < options.directions; ++i) {
        const double azimuth = 2 * kPi * (i + 0.5) / options.directions;
        double steepest = 0, step = 0.5, d = 0.5;
        while (d <= options.reach_mm) {
          const double height = field.Lookup(row - d * std::sin(azimuth) / field.texel_y_mm,
                                             column + d * std::cos(azimuth) / field.texel_x_mm);
          steepest = std::max(steepest, (height - field.at(row, column)) / d);
          step *= options.step_growth;
          d += step;
        }
        sum += 1 / (1 + steepest * steepest);
      }
      EXPECT_NEAR(open[static_cast<size_t>(row * field.width + column)], sum / options.directions,
                  1e-5);
    }
  }
}

// Cut elsewhere, a relief that repeats is the same relief.
TEST(AmbientOcclusion, OfARepeatingReliefDependsOnNoBorder) {
  HeightField field = Bumps(32, 7);
  field.repeats = true;
  HeightField cut = field;
  const auto elsewhere = [](int row, int column) {
    return static_cast<size_t>((row + 11) % 32 * 32 + (column + 23) % 32);
  };
  for (int row = 0; row < 32; ++row) {
    for (int column = 0; column < 32; ++column) {
      cut.height_mm[elsewhere(row, column)] = field.at(row, column);
    }
  }
  OcclusionOptions options;
  options.reach_mm = 30;  // further than the relief is wide
  const std::vector<float> open = AmbientOcclusion(field, options, 1);
  const std::vector<float> open_of_cut = AmbientOcclusion(cut, options, 1);
  for (int row = 0; row < 32; ++row) {
    for (int column = 0; column < 32; ++column) {
      EXPECT_EQ(open[static_cast<size_t>(row * 32 + column)], open_of_cut[elsewhere(row, column)]);
    }
  }
}

TEST(AmbientOcclusion, DoesNotDependOnTheNumberOfThreads) {
  const HeightField field = Bumps(40, 5);
  EXPECT_EQ(AmbientOcclusion(field, {}, 1), AmbientOcclusion(field, {}, 3));
}

}  // namespace
}  // namespace glint
