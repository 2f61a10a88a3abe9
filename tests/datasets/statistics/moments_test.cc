#include "datasets/statistics/moments.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

namespace glint {
namespace {

constexpr int kPlaneSide = 64;

std::vector<float> Noise(unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<float> normal(2, 3);
  std::vector<float> plane(kPlaneSide * kPlaneSide);
  for (float& value : plane) value = normal(random);
  return plane;
}

TEST(MomentsTest, ANormalDistributionHasItsMoments) {
  const Moments m = MomentsOf(Noise(1));
  EXPECT_NEAR(m.mean, 2, 0.15);
  EXPECT_NEAR(m.spread, 3, 0.1);
  EXPECT_NEAR(m.skewness, 0, 0.1);
  EXPECT_NEAR(m.kurtosis, 3, 0.25);
}

TEST(MomentsTest, CorrelationIsOneForGainsAndMinusOneForNegatives) {
  const std::vector<float> a = Noise(1);
  std::vector<float> gain = a, negative = a;
  for (float& value : gain) value = 0.3f * value + 1;
  for (float& value : negative) value = -value;
  EXPECT_NEAR(Correlation(a, gain), 1, 1e-6);
  EXPECT_NEAR(Correlation(a, negative), -1, 1e-6);
  EXPECT_NEAR(Correlation(a, Noise(2)), 0, 0.05);
}

TEST(MomentsTest, CorrelationWithAFlatPlaneIsUndefined) {
  EXPECT_TRUE(std::isnan(Correlation(Noise(1), std::vector<float>(kPlaneSide * kPlaneSide, 0.4f))));
}

TEST(MomentsTest, FineCorrelationSeesDetailUnderASlowGradient) {
  const std::vector<float> detail = Noise(1);
  std::vector<float> a = detail, b = detail;
  for (size_t i = 0; i < a.size(); ++i) {  // opposite gradients hide that the details agree
    a[i] += 1.0f * static_cast<float>(i % kPlaneSide);
    b[i] -= 1.0f * static_cast<float>(i % kPlaneSide);
  }
  EXPECT_LT(Correlation(a, b), -0.8);
  EXPECT_NEAR(FineCorrelation(a, b, kPlaneSide), 1, 1e-4);
}

TEST(MomentsTest, StripesHaveADirectionAndNoiseHasNone) {
  std::vector<float> stripes(kPlaneSide * kPlaneSide);
  for (int i = 0; i < kPlaneSide * kPlaneSide; ++i) {
    const int row = i / kPlaneSide, column = i % kPlaneSide;
    stripes[static_cast<size_t>(i)] = std::sin(0.3f * static_cast<float>(row + column));
  }
  EXPECT_NEAR(Directionality(stripes, kPlaneSide), 1, 1e-3);
  EXPECT_LT(Directionality(Noise(1), kPlaneSide), 0.1);
  EXPECT_EQ(Directionality(std::vector<float>(kPlaneSide * kPlaneSide, 0.5f), kPlaneSide), 0);
}

}  // namespace
}  // namespace glint
