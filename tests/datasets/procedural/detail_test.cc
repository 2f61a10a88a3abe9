#include "datasets/procedural/detail.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace glint::procedural {
namespace {

struct Spread {
  double mean = 0, deviation = 0;
};

Spread SpreadOf(std::span<const float> plane) {
  double sum = 0, square = 0;
  for (const float v : plane) sum += v, square += static_cast<double>(v) * v;
  const double n = static_cast<double>(plane.size());
  return {sum / n, std::sqrt(square / n - sum * sum / (n * n))};
}

// Correlation of texels with those `dx` to the right and `dy` below.
double NeighbourCorrelation(const Plane& plane, int side, int dx, int dy) {
  double product = 0, square = 0;
  for (int y = 0; y + dy < side; ++y) {
    for (int x = 0; x + dx < side; ++x) {
      const double a = plane[static_cast<size_t>(y) * side + x];
      product += a * plane[static_cast<size_t>(y + dy) * side + x + dx];
      square += a * a;
    }
  }
  return product / square;
}

DetailOptions Options(float gain) {
  DetailOptions o;
  o.gain = gain;
  o.seed = 7;
  return o;
}

TEST(DetailTest, SpreadIsAboutOneForAnyGain) {
  for (const float gain : {0.8f, 1.3f, 2.0f}) {
    const Spread s = SpreadOf(DetailNoise(Options(gain), 256, 256));
    EXPECT_NEAR(s.mean, 0, 0.35) << gain;
    EXPECT_NEAR(s.deviation, 1, 0.35) << gain;
  }
}

TEST(DetailTest, GainLeadsFromSmoothFormsToTexelNoise) {
  EXPECT_GT(NeighbourCorrelation(DetailNoise(Options(0.6f), 256, 256), 256, 1, 0), 0.85);
  EXPECT_LT(NeighbourCorrelation(DetailNoise(Options(2.0f), 256, 256), 256, 1, 0), 0.25);
}

TEST(DetailTest, FormsStayWhereTheyAreAtAnotherResolution) {
  const Plane coarse = DetailNoise(Options(0.8f), 128, 128);
  const Plane fine = DetailNoise(Options(0.8f), 256, 256);
  double product = 0, a = 0, b = 0;
  for (int y = 0; y < 128; ++y) {
    for (int x = 0; x < 128; ++x) {
      const size_t at = static_cast<size_t>(2 * y) * 256 + 2 * x;
      const double mean = 0.25 * (fine[at] + fine[at + 1] + fine[at + 256] + fine[at + 257]);
      const double value = coarse[static_cast<size_t>(y) * 128 + x];
      product += mean * value;
      a += mean * mean;
      b += value * value;
    }
  }
  EXPECT_GT(product / std::sqrt(a * b), 0.93);
}

TEST(DetailTest, LargePicturesKeepTheContrast) {
  for (const float gain : {0.8f, 2.1f}) {
    const double at_256 = SpreadOf(DetailNoise(Options(gain), 256, 256)).deviation;
    EXPECT_NEAR(SpreadOf(DetailNoise(Options(gain), 1024, 1024)).deviation / at_256, 1, 0.3)
        << gain;
  }
}

TEST(DetailTest, StretchMakesStreaks) {
  DetailOptions o = Options(1.6f);
  o.stretch_y = 3;
  const Plane plane = DetailNoise(o, 256, 256);
  EXPECT_GT(NeighbourCorrelation(plane, 256, 0, 1), 0.8);
  EXPECT_LT(NeighbourCorrelation(plane, 256, 1, 0), 0.5);
}

TEST(DetailTest, OddSizesAreFilled) {
  const Plane plane = DetailNoise(Options(1.5f), 61, 17);
  ASSERT_EQ(plane.size(), 61u * 17u);
  for (const float v : plane) ASSERT_TRUE(std::isfinite(v) && std::fabs(v) < 8);
}

TEST(BlurTest, KeepsLevelsAndTheMeanAndTakesTexelNoise) {
  const std::vector<float> level(40 * 30, 0.7f);
  for (const float v : Blurred(level.data(), 40, 30, 40, 5)) ASSERT_NEAR(v, 0.7f, 1e-5f);
  const Plane noise = DetailNoise(Options(2.0f), 128, 128);
  const Spread before = SpreadOf(noise);
  const Spread after = SpreadOf(Blurred(noise.data(), 128, 128, 128, 4));
  EXPECT_NEAR(after.mean, before.mean, 0.05);
  EXPECT_LT(after.deviation, 0.3 * before.deviation);
}

TEST(BlurTest, TheRadiusMayExceedThePicture) {
  const std::vector<float> ramp{0, 1, 2, 3};
  for (const float v : Blurred(ramp.data(), 2, 2, 2, 9)) EXPECT_NEAR(v, 1.5f, 0.2f);
}

}  // namespace
}  // namespace glint::procedural
