#include "fitting/refine/spread_search.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <vector>

namespace glint {
namespace {

// A bowl whose least value is at `lowest`, with a valley along which specular and diffuse albedo's
// spreads stand in for each other: the steeper its sides, the longer its floor.
double Bowl(const SpreadPowers& powers, const SpreadPowers& lowest, double sides = 0.03) {
  double sum = 1;
  std::array<double, kSpreadKinds> off;
  for (size_t i = 0; i < kSpreadKinds; ++i) {
    off[i] = powers[i] - lowest[i];
    sum += 0.1 * off[i] * off[i];
  }
  return sum + sides * std::pow(off[kSpecularSpread] + off[kDiffuseSpread], 2);
}

constexpr double kMany = 1e6;  // residuals: what is expected beforehand does not matter

TriedSpreads Best(const std::vector<TriedSpreads>& tried) {
  return *std::min_element(
      tried.begin(), tried.end(),
      [](const TriedSpreads& a, const TriedSpreads& b) { return a.error < b.error; });
}

// With diffuse albedo's spread as it is at first, narrower ones of roughness and specular albedo
// are better than those that are best beside a narrow one: directions are tried again.
TEST(SpreadSearch, FindsSpreadsThatStandInForEachOther) {
  const SpreadPowers lowest = {0, -1, 1, -2, 3};
  const auto error = [&](const SpreadPowers& p) { return Bowl(p, lowest, 0.08); };
  ASSERT_LT(error({-1, -2, 1, 0, 0}), error({0, -1, 1, 0, 0}));
  EXPECT_EQ(Best(SearchSpreads(error, kMany)).powers, lowest);
}

TEST(SpreadSearch, SpecularAlbedosSpreadReachesFurtherDownThanRoughnesss) {
  const SpreadPowers lowest = {-9, -9, -2, 0, 0};
  const SpreadPowers best =
      Best(SearchSpreads([&](const SpreadPowers& p) { return Bowl(p, lowest, 0); }, kMany)).powers;
  EXPECT_LT(best[kSpecularSpread], best[kRoughnessSpread]);
}

// Of the initialisation, whose errors are not thought smaller than they are said to be.
bool OutOfRange(const SpreadPowers& powers) { return powers[kInitialisationError] < 0; }

TEST(SpreadSearch, TriesEachOnceAndTheBestOnesNeighbours) {
  std::set<SpreadPowers> asked;
  const auto error = [&](const SpreadPowers& powers) {
    EXPECT_TRUE(asked.insert(powers).second);
    return Bowl(powers, {-1, 0, 0, 0, 0});
  };
  const auto tried = SearchSpreads(error, kMany);
  EXPECT_EQ(tried.size(), asked.size());
  const SpreadPowers best = Best(tried).powers;
  for (const SpreadPowers& direction :
       {SpreadPowers{1, 1, 0, 0, 0}, SpreadPowers{0, 0, 1, 0, 0}, SpreadPowers{0, 1, 0, 0, 0},
        SpreadPowers{0, 0, 0, 1, 0}, SpreadPowers{0, 0, 0, 0, 1}}) {
    for (const int sign : {-1, 1}) {
      SpreadPowers next = best;
      for (size_t i = 0; i < kSpreadKinds; ++i) next[i] += sign * direction[i];
      EXPECT_TRUE(asked.contains(next) || OutOfRange(next));
    }
  }
}

TEST(SpreadSearch, EndsWhereErrorsFallForEver) {
  const auto error = [](const SpreadPowers& powers) {
    return 1.0 / (1 + std::exp2(powers[0]) + std::exp2(-powers[3]) + std::exp2(powers[4]));
  };
  const auto tried = SearchSpreads(error, kMany);
  EXPECT_LT(tried.size(), 40u);
  const SpreadPowers best = Best(tried).powers;
  EXPECT_EQ(best[kRoughnessSpread], 1);
  EXPECT_EQ(best[kDiffuseSpread], -3);
  EXPECT_EQ(best[kInitialisationError], 4);
}

// A rough specular lobe in place of diffuse light predicts as well: what is said of the
// initialisation's errors tells the two apart.
TEST(SpreadSearch, TheInitialisationErrsAsIsSaidWherePhotographsDoNotTell) {
  const auto error = [](const SpreadPowers& p) { return 1 - 0.002 * p[kInitialisationError]; };
  constexpr double kFew = 300;
  const auto tried = SearchSpreads(error, kFew);
  EXPECT_EQ(Best(tried).powers[kInitialisationError], 1);  // of the two that were tried
  EXPECT_LT(ProbableFactors(tried, kFew)[kInitialisationError], 1.5);
  EXPECT_GT(ProbableFactors(SearchSpreads(error, kMany), kMany)[kInitialisationError], 15);
}

// All photographs held out are masked: nothing is told apart, and nothing is not a number.
TEST(SpreadSearch, WhereNothingIsPredictedAllAreAsLikely) {
  const SpreadFactors factors = ProbableFactors({{{-1, 0, 0, 0, 0}, 0}, {{1, 0, 0, 0, 0}, 0}}, 1e3);
  EXPECT_NEAR(factors[kRoughnessSpread], std::sqrt((0.25 + 4) / 2), 1e-12);
}

TEST(SpreadSearch, OneThatPredictsFarBetterIsTaken) {
  const SpreadFactors factors =
      ProbableFactors({{{0, 0, 0, 0, 0}, 1}, {{1, -2, 0, -3, 2}, .5}}, 1e3);
  const SpreadFactors expected = {2, 0.25, 1, 0.125, 4};
  for (size_t i = 0; i < kSpreadKinds; ++i) EXPECT_NEAR(factors[i], expected[i], 1e-9) << i;
}

// What is as likely widens a spread more than it narrows one.
TEST(SpreadSearch, WhatIsAsLikelyCountsByItsVariance) {
  const SpreadFactors factors =
      ProbableFactors({{{-1, 0, 0, -1, 0}, 1}, {{1, 0, 0, 1, 0}, 1}}, 1e3);
  EXPECT_NEAR(factors[kRoughnessSpread], std::sqrt((0.25 + 4) / 2), 1e-12);
  EXPECT_NEAR(factors[kDiffuseSpread], 1, 1e-12);
  EXPECT_NEAR(FactorOfMeanPrecision(std::array{0.5, 2.0}, {1, 1}, 1e3),
              1 / std::sqrt((0.25 + 4) / 2), 1e-12);
}

}  // namespace
}  // namespace glint
