// What photographs blur of texels is told apart as far as they tell it, and nothing else changes.
#include "fitting/refine/point_spread.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>
#include <random>

#include "tests/fitting/refine/synthetic_scene.h"

namespace glint {
namespace {

std::vector<float> RandomPlane(int width, int height, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> uniform(0.0f, 1.0f);
  std::vector<float> plane(static_cast<size_t>(width) * height);
  for (float& value : plane) value = uniform(random);
  return plane;
}

TEST(PointSpread, HasTheStatedVarianceAndKeepsConstants) {
  constexpr int kSize = 41, kMiddle = kSize / 2;
  for (const double pixels_per_texel : {0.3, 0.5, 0.7, 1.0}) {
    const PointSpread spread(pixels_per_texel, 0.67);
    ASSERT_FALSE(spread.none());
    std::vector<float> point(kSize * kSize, 0.0f);
    point[kMiddle * kSize + kMiddle] = 1.0f;
    const std::vector<float> spot = spread.Blurred(point, kSize, kSize);
    double sum = 0, across = 0, down = 0;
    for (int row = 0; row < kSize; ++row) {
      for (int column = 0; column < kSize; ++column) {
        const double value = spot[static_cast<size_t>(row) * kSize + column];
        sum += value;
        across += value * (column - kMiddle) * (column - kMiddle);
        down += value * (row - kMiddle) * (row - kMiddle);
        EXPECT_TRUE(value == 0 || std::abs(row - kMiddle) <= spread.reach());
      }
    }
    EXPECT_NEAR(sum, 1, 1e-5);
    EXPECT_NEAR(across, spread.variance(), 1e-4);
    EXPECT_NEAR(down, spread.variance(), 1e-4);
    const std::vector<float> even(kSize * kSize, 0.3f);
    for (const float value : spread.Blurred(even, kSize, kSize)) EXPECT_NEAR(value, 0.3f, 1e-6f);
  }
}

// Of 12 megapixels on a sample of 2048² the spread is what was measured of synthetic photographs.
TEST(PointSpread, IsWiderTheFinerTexelsAre) {
  EXPECT_TRUE(PointSpread(0, 0.67).none());    // not known
  EXPECT_TRUE(PointSpread(0.5, 0).none());     // none is wanted
  EXPECT_TRUE(PointSpread(2.3, 0.67).none());  // texels are coarser
  EXPECT_NEAR(std::sqrt(PointSpread(0.49, 0.67).variance()), 1.35, 0.03);
  EXPECT_LT(PointSpread(1.0, 0.67).variance(), PointSpread(0.7, 0.67).variance());
  EXPECT_EQ(PointSpread(0.1, 0.67).variance(), PointSpread(0.01, 0.67).variance());
}

TEST(PointSpread, IsItsOwnTransposeAwayFromTheBorder) {
  constexpr int kWidth = 37, kHeight = 29, kRim = 8;
  const PointSpread spread(0.5, 0.67);
  std::vector<float> a = RandomPlane(kWidth, kHeight, 1), b = RandomPlane(kWidth, kHeight, 2);
  for (int row = 0; row < kHeight; ++row) {
    for (int column = 0; column < kWidth; ++column) {
      if (std::min({row, column, kHeight - 1 - row, kWidth - 1 - column}) >= kRim) continue;
      a[static_cast<size_t>(row) * kWidth + column] = 0;
      b[static_cast<size_t>(row) * kWidth + column] = 0;
    }
  }
  const auto product = [](const std::vector<float>& x, const std::vector<float>& y) {
    return std::inner_product(x.begin(), x.end(), y.begin(), 0.0);
  };
  EXPECT_NEAR(product(a, spread.Blurred(b, kWidth, kHeight)),
              product(spread.Blurred(a, kWidth, kHeight), b), 1e-3);
}

TEST(Deblurred, OfARenderingThatExplainsThePhotographIsTheRendering) {
  constexpr int kSize = 32;
  const PointSpread spread(0.5, 0.67);
  std::vector<float> rendering = RandomPlane(kSize, 3 * kSize, 3);
  const std::vector<float> photograph = spread.Blurred(rendering, kSize, kSize);
  const std::vector<float> mask(kSize * kSize, 1.0f);
  const std::vector<float> deblurred =
      Deblurred(spread, photograph, mask, false, rendering, kSize, kSize);
  for (size_t i = 0; i < deblurred.size(); ++i) EXPECT_NEAR(deblurred[i], rendering[i], 1e-5f);
}

TEST(Deblurred, MaskedTexelsSayNothingAndClippedOnesStay) {
  constexpr int kSize = 24;
  constexpr size_t kTexel = 12 * kSize + 12;
  const PointSpread spread(0.5, 0.67);
  const std::vector<float> rendering(3 * kSize * kSize, 0.5f);
  std::vector<float> photograph = rendering, mask(kSize * kSize, 1.0f);
  mask[kTexel] = 0;
  photograph[kTexel] = NAN;
  std::vector<float> deblurred = Deblurred(spread, photograph, mask, true, rendering, kSize, kSize);
  for (const float value : deblurred) EXPECT_NEAR(value, 0.5f, 1e-5f);
  mask[kTexel] = 1;
  photograph[kTexel] = 1;  // at least 1, for .5
  deblurred = Deblurred(spread, photograph, mask, true, rendering, kSize, kSize);
  EXPECT_EQ(deblurred[kTexel], 1);
  EXPECT_GT(deblurred[kTexel + 1], 0.5f);
}

// Of one material with a fine relief, photographed with half a pixel to a texel.
class Blurred : public ::testing::Test {
 protected:
  static constexpr int kSize = 40;
  static constexpr double kPixelsPerTexel = 0.5, kSpread_px = 0.67;

  Blurred() : scene_(test::Photograph(Relief(), 10)), start_(scene_.truth) {
    const PointSpread spread(kPixelsPerTexel, kSpread_px);
    for (std::vector<float>& photograph : scene_.photographs) {
      photograph = spread.Blurred(photograph, kSize, kSize);
    }
    for (size_t t = 0; t < start_.texels(); ++t) {  // an even surface, a little off
      start_.plane(kNormalX)[t] = start_.plane(kNormalY)[t] = 0;
      start_.plane(kNormalZ)[t] = 1;
      start_.plane(kRoughness)[t] = 0.45f;
    }
  }

  static SvbrdfMaps Relief() {
    SvbrdfMaps maps = test::QuarteredMaps(kSize, 3);
    for (size_t t = 0; t < maps.texels(); ++t) {
      const int row = static_cast<int>(t) / kSize, column = static_cast<int>(t) % kSize;
      const double x = 0.2 * std::sin(2 * M_PI * column / 7),
                   y = 0.2 * std::sin(2 * M_PI * row / 9);
      const double length = std::sqrt(1 + x * x + y * y);
      maps.plane(kNormalX)[t] = static_cast<float>(x / length);
      maps.plane(kNormalY)[t] = static_cast<float>(y / length);
      maps.plane(kNormalZ)[t] = static_cast<float>(1 / length);
      maps.plane(kRoughness)[t] = 0.4f;
      for (int c = 0; c < 3; ++c) {
        maps.plane(kDiffuseR + c)[t] = 0.2f;
        maps.plane(kSpecularR + c)[t] = 0.06f;
      }
    }
    return maps;
  }

  SvbrdfMaps Refined(double pixels_per_texel, int passes) const {
    RefineProblem problem = scene_.Problem();
    for (RefineView& view : problem.views) view.pixels_per_texel = pixels_per_texel;
    RefineOptions options;
    options.neighbour_passes = passes;
    return Refine(problem, start_, options, 2).maps;
  }

  double Error(const SvbrdfMaps& maps, int first, int last) const {
    return test::MeanSquare(maps, scene_.truth, first, last);
  }

  test::SyntheticScene scene_;
  SvbrdfMaps start_;
};

// Of normals alone: a substance's mean roughness is estimated from photographs as they are, and
// texels are held to it.
TEST_F(Blurred, NormalsAreFoundThatPhotographsBlur) {
  // Every pass takes away b² of what is missing, b = .5 for these slopes.
  const SvbrdfMaps taken_as_sharp = Refined(0, 8), deblurred = Refined(kPixelsPerTexel, 8);
  EXPECT_LT(Error(deblurred, kNormalX, kNormalY), 0.5 * Error(taken_as_sharp, kNormalX, kNormalY));
}

TEST_F(Blurred, WhereTexelsAreCoarserThanPixelsNothingChanges) {
  EXPECT_EQ(Refined(0, 1).planes, Refined(3, 1).planes);
}

}  // namespace
}  // namespace glint
