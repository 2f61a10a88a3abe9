#include "datasets/statistics/distance.h"

#include <gtest/gtest.h>

#include <random>

#include "base/statistics/quantile.h"

namespace glint {
namespace {

TEST(DistanceTest, EqualSamplesAreAtZeroInAnyOrder) {
  EXPECT_EQ(KolmogorovSmirnov({3, 1, 2, 2}, {2, 1, 2, 3}), 0);
  EXPECT_EQ(Wasserstein({3, 1, 2, 2}, {2, 1, 2, 3}), 0);
}

TEST(DistanceTest, AShiftCostsItsLength) {
  EXPECT_DOUBLE_EQ(Wasserstein({0, 1, 5}, {0.25, 1.25, 5.25}), 0.25);
  EXPECT_DOUBLE_EQ(Wasserstein({0, 1}, {1, 2, 0, 1}), 0.5);  // sizes may differ
}

TEST(DistanceTest, SeparateSamplesAreOneApart) {
  EXPECT_EQ(KolmogorovSmirnov({0, 1}, {2, 3, 4}), 1);
  EXPECT_EQ(KolmogorovSmirnov({}, {2}), 1);
  EXPECT_DOUBLE_EQ(KolmogorovSmirnov({1, 2, 3, 4}, {1, 2, 9, 9}), 0.5);
}

TEST(DistanceTest, HistogramsAgreeWithTheirSamples) {
  const std::vector<double> a{0.5, 0.5, 0, 0}, b{0, 0, 0.5, 0.5};
  EXPECT_EQ(HistogramKolmogorovSmirnov(a, b), 1);
  EXPECT_DOUBLE_EQ(HistogramWasserstein(a, b, 0.25), Wasserstein({0, 0.25}, {0.5, 0.75}));
  EXPECT_EQ(HistogramWasserstein(a, a, 0.25), 0);
}

TEST(DistanceTest, AlikeSamplesShowTheExpectedDistance) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> uniform(0, 1);
  double mean = 0;
  for (int round = 0; round < 300; ++round) {
    std::vector<double> a(70), b(200);
    for (double& value : a) value = uniform(random);
    for (double& value : b) value = uniform(random);
    mean += KolmogorovSmirnov(a, b) / 300;
  }
  EXPECT_NEAR(mean, ExpectedKolmogorovSmirnov(70, 200), 0.012);
}

TEST(DistanceTest, QuantilesInterpolate) {
  EXPECT_DOUBLE_EQ(Quantile({4, 0, 2}, 0.5), 2);
  EXPECT_DOUBLE_EQ(Quantile({4, 0, 2}, 0.75), 3);
  EXPECT_EQ(Quantile({}, 0.5), 0);
}

}  // namespace
}  // namespace glint
