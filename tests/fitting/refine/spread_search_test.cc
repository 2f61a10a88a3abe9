#include "fitting/refine/spread_search.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <vector>

namespace glint {
namespace {

// A bowl whose least value is at `lowest`, with a valley along which two spreads stand in for each
// other.
double Bowl(const SpreadPowers& powers, const SpreadPowers& lowest, double valley = 0.03) {
  double sum = 1;
  std::array<double, kSpreadKinds> off;
  for (size_t i = 0; i < kSpreadKinds; ++i) {
    off[i] = powers[i] - lowest[i];
    sum += 0.1 * off[i] * off[i];
  }
  return sum + valley * std::pow(off[kSpecularSpread] + off[kDiffuseSpread], 2);
}

TriedSpreads Best(const std::vector<TriedSpreads>& tried) {
  return *std::min_element(
      tried.begin(), tried.end(),
      [](const TriedSpreads& a, const TriedSpreads& b) { return a.error < b.error; });
}

TEST(SpreadSearch, FindsSpreadsThatStandInForEachOther) {
  const SpreadPowers lowest = {-1, -1, 1, -2, 3};
  const auto tried = SearchSpreads([&](const SpreadPowers& p) { return Bowl(p, lowest); });
  EXPECT_EQ(Best(tried).powers, lowest);
}

// As of a dielectric with one specular albedo and roughnesses of all kinds.
TEST(SpreadSearch, SpecularAlbedoMayHardlyVaryWhereRoughnessDoes) {
  const SpreadPowers lowest = {-2, -4, -2, 0, 0};
  const auto tried = SearchSpreads([&](const SpreadPowers& p) { return Bowl(p, lowest); });
  EXPECT_EQ(Best(tried).powers, lowest);
}

TEST(SpreadSearch, TriesEachOnceAndTheBestOnesNeighbours) {
  std::set<SpreadPowers> asked;
  const auto tried = SearchSpreads([&](const SpreadPowers& powers) {
    EXPECT_TRUE(asked.insert(powers).second);
    return Bowl(powers, {0, 1, 0, 0, 1});
  });
  EXPECT_EQ(tried.size(), asked.size());
  const SpreadPowers best = Best(tried).powers;
  for (const SpreadPowers& direction :
       {SpreadPowers{1, 1, 0, 0, 0}, SpreadPowers{0, 0, 1, 0, 0}, SpreadPowers{0, 1, 0, 0, 0},
        SpreadPowers{0, 0, 0, 1, 0}, SpreadPowers{0, 0, 0, 0, 1}}) {
    SpreadPowers below = best;
    for (size_t i = 0; i < kSpreadKinds; ++i) below[i] -= direction[i];
    EXPECT_TRUE(asked.contains(below));
  }
}

TEST(SpreadSearch, EndsWhereErrorsFallForEver) {
  const auto tried = SearchSpreads([](const SpreadPowers& powers) {
    return 1.0 / (1 + std::exp2(powers[0]) + std::exp2(-powers[3]) + std::exp2(powers[4]));
  });
  EXPECT_LT(tried.size(), 40u);
  const SpreadPowers best = Best(tried).powers;
  EXPECT_EQ(best[kRoughnessSpread], 1);
  EXPECT_EQ(best[kDiffuseSpread], -3);
  EXPECT_EQ(best[kInitialisationError], 4);
}

// All photographs held out are masked: nothing is told apart, and nothing is not a number.
TEST(SpreadSearch, WhereNothingIsPredictedAllAreAsLikely) {
  const SpreadFactors factors = LikelyFactors({{{-1, 0, 0, 0, 0}, 0}, {{1, 0, 0, 0, 0}, 0}}, 1e3);
  EXPECT_NEAR(factors[kRoughnessSpread], std::sqrt((0.25 + 4) / 2), 1e-12);
}

TEST(SpreadSearch, OneThatPredictsFarBetterIsTaken) {
  const SpreadFactors factors = LikelyFactors({{{0, 0, 0, 0, 0}, 1}, {{1, -2, 0, -3, 2}, .5}}, 1e3);
  const SpreadFactors expected = {2, 0.25, 1, 0.125, 4};
  for (size_t i = 0; i < kSpreadKinds; ++i) EXPECT_NEAR(factors[i], expected[i], 1e-9) << i;
}

// What is as likely widens a spread more than it narrows one.
TEST(SpreadSearch, WhatIsAsLikelyCountsByItsVariance) {
  const SpreadFactors factors = LikelyFactors({{{-1, 0, 0, -1, 0}, 1}, {{1, 0, 0, 1, 0}, 1}}, 1e3);
  EXPECT_NEAR(factors[kRoughnessSpread], std::sqrt((0.25 + 4) / 2), 1e-12);
  EXPECT_NEAR(factors[kDiffuseSpread], 1, 1e-12);
  EXPECT_NEAR(FactorOfMeanPrecision(std::array{0.5, 2.0}, {1, 1}, 1e3),
              1 / std::sqrt((0.25 + 4) / 2), 1e-12);
}

}  // namespace
}  // namespace glint
