#include "fitting/refine/spread_search.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <optional>
#include <random>
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

// At so many places, where errors scatter by a tenth: the fewer they are, the less sure it is which
// of two sums is smaller (energies of 100 · places · L²).
class Places {
 public:
  explicit Places(size_t count) : count_(count) {}

  HeldOutErrors operator()(double error) {
    HeldOutErrors errors(count_);
    errors.BeginFold();
    errors.BeginFold();
    std::normal_distribution<double> scatter(1, 0.1);
    std::vector<double> squares(count_);
    double sum = 0;
    for (double& one : squares) sum += one = scatter(random_);
    for (size_t i = 0; i < count_; ++i) errors.Add(i, error * squares[i] / sum);
    return errors;
  }

 private:
  size_t count_;
  std::mt19937 random_;
};
constexpr size_t kMany = 100000;  // what is expected beforehand does not matter

SpreadPowers Best(const std::vector<TriedSpreads>& tried) { return tried.front().powers; }

// With diffuse albedo's spread as it is at first, narrower ones of roughness and specular albedo
// are better than those that are best beside a narrow one: directions are tried again.
TEST(SpreadSearch, FindsSpreadsThatStandInForEachOther) {
  const SpreadPowers lowest = {0, -1, 1, -2, 3};
  const auto error = [&](const SpreadPowers& p) { return Bowl(p, lowest, 0.08); };
  ASSERT_LT(error({-1, -2, 1, 0, 0}), error({0, -1, 1, 0, 0}));
  Places at(kMany);
  EXPECT_EQ(Best(SearchSpreads([&](const SpreadPowers& p, const GiveUp&) { return at(error(p)); })),
            lowest);
}

TEST(SpreadSearch, SpecularAlbedosSpreadReachesFurtherDownThanRoughnesss) {
  Places at(kMany);
  const SpreadPowers best = Best(SearchSpreads([&](const SpreadPowers& p, const GiveUp&) {
    return at(Bowl(p, {-9, -9, -2, 0, 0}, 0));
  }));
  EXPECT_LT(best[kSpecularSpread], best[kRoughnessSpread]);
}

// Of the initialisation, whose errors are not thought smaller than they are said to be.
bool OutOfRange(const SpreadPowers& powers) { return powers[kInitialisationError] < 0; }

TEST(SpreadSearch, TriesEachOnceAndTheBestOnesNeighbours) {
  std::set<SpreadPowers> asked;
  Places at(kMany);
  const SpreadPowers best = Best(SearchSpreads([&](const SpreadPowers& powers, const GiveUp&) {
    EXPECT_TRUE(asked.insert(powers).second);
    return at(Bowl(powers, {-1, 0, 0, 0, 0}));
  }));
  for (const SpreadPowers& direction :
       {SpreadPowers{1, 1, 0, 0, 0}, SpreadPowers{1, 0, 0, 0, 0}, SpreadPowers{0, 0, 1, 0, 0},
        SpreadPowers{0, 1, 0, 0, 0}, SpreadPowers{0, 0, 0, 1, 0}, SpreadPowers{0, 0, 0, 0, 1},
        SpreadPowers{0, 0, 0, 0, 0, 1}}) {
    for (const int sign : {-1, 1}) {
      SpreadPowers next = best;
      for (size_t i = 0; i < kSpreadKinds; ++i) next[i] += sign * direction[i];
      EXPECT_TRUE(asked.contains(next) || OutOfRange(next));
    }
  }
}

TEST(SpreadSearch, EndsWhereErrorsFallForEver) {
  int tried = 0;
  Places at(kMany);
  const SpreadPowers best = Best(SearchSpreads([&](const SpreadPowers& powers, const GiveUp&) {
    ++tried;
    return at(1.0 / (1 + std::exp2(powers[0]) + std::exp2(-powers[3]) + std::exp2(powers[4])));
  }));
  EXPECT_LT(tried, 80);
  EXPECT_EQ(best[kRoughnessSpread], 2);
  EXPECT_EQ(best[kDiffuseSpread], -3);
  EXPECT_EQ(best[kInitialisationError], 4);
}

// A rough specular lobe in place of diffuse light predicts as well: what is said of the
// initialisation's errors tells the two apart.
TEST(SpreadSearch, TheInitialisationErrsAsIsSaidWherePhotographsDoNotTell) {
  const auto factor = [](size_t places) {
    Places at(places);
    return ProbableFactors(SearchSpreads([&](const SpreadPowers& p, const GiveUp&) {
      return at(1 - 0.002 * p[kInitialisationError]);
    }))[kInitialisationError];
  };
  // Mean of 1, 2, 4 and 8 by a Gaussian of their logarithm, one octave wide.
  double weights = 0, mean = 0;
  for (int octaves = 0; octaves <= 3; ++octaves) {
    const double weight = std::exp(-0.5 * octaves * octaves);
    weights += weight;
    mean += weight * std::exp2(octaves);
  }
  EXPECT_NEAR(factor(30), mean / weights, 0.05);
  EXPECT_GT(factor(kMany), 15);
}

// All photographs held out are masked: nothing is told apart, and nothing is not a number.
TEST(SpreadSearch, WhereNothingIsPredictedAllAreAsLikely) {
  Places at(10);
  const auto tried = SearchSpreads([&](const SpreadPowers&, const GiveUp&) { return at(0); });
  const SpreadFactors factors = ProbableFactors(tried);
  EXPECT_NEAR(factors[kRoughnessSpread], (0.25 + 0.5 + 1 + 2 + 4) / 5, 1e-12);
}

// Four folds of eight places, whose errors scatter by 1 %, the same for the same powers.
HeldOutErrors Scattered(const SpreadPowers& powers, double error, int first_folds = 4) {
  std::seed_seq seed(powers.begin(), powers.end());
  std::mt19937 random(seed);
  std::normal_distribution<double> scatter(1, 0.01);
  HeldOutErrors errors(8);
  for (int fold = 0; fold < first_folds; ++fold) {
    errors.BeginFold();
    for (size_t place = 0; place < 8; ++place) errors.Add(place, error * scatter(random));
  }
  return errors;
}

// The same are found as when all are finished, and much of what lies far off is not finished.
TEST(SpreadSearch, WhatIsOutOfTheQuestionByItsFirstFoldsIsGivenUp) {
  const SpreadPowers lowest = {-1, -3, 0, -2, 0};
  int given_up = 0;
  const auto search = [&](bool by_first_folds) {
    return SearchSpreads([&](const SpreadPowers& powers, const GiveUp& give_up) {
      const double error = 1 + 0.05 * Bowl(powers, lowest, 0.08);
      HeldOutErrors first = Scattered(powers, error, 2);
      if (!by_first_folds || !give_up || !give_up(first)) return Scattered(powers, error);
      ++given_up;
      return first;
    });
  };
  const auto all = search(false), some = search(true);
  EXPECT_EQ(Best(some), Best(all));
  EXPECT_GE(given_up, 5);
  const SpreadFactors of_all = ProbableFactors(all), of_some = ProbableFactors(some);
  for (size_t i = 0; i < kSpreadKinds; ++i) EXPECT_NEAR(of_some[i], of_all[i], 0.05) << i;
}

// By its first folds one is far worse than those begun with, which are worse than what is found
// later; against that it is asked again, in full.
TEST(SpreadSearch, WhatWasGivenUpIsFinishedWhereItIsProbable) {
  const SpreadPowers misjudged = {0, 0, 0, 0, 0, -1}, better = {0, 0, 0, 0, 0, 1};
  int finished = 0;
  const auto errors_of = [&](const SpreadPowers& powers, const GiveUp& give_up) {
    // By place, the places that are wrong with one being right with the other: what differs in many
    // ways is not told apart.
    std::vector<double> places(8, powers == SpreadPowers{} ? 1.0 : 4.0);
    if (powers == better) places = {0.1, 1.7, 0.1, 1.7, 0.1, 1.7, 0.1, 1.7};
    if (powers == misjudged) places = {1.04, 1.05, 1.04, 1.05, 1.04, 1.05, 1.04, 1.05};
    HeldOutErrors errors(8);
    for (int fold = 0; fold < 4; ++fold) {
      if (fold == 2 && give_up && give_up(errors)) return errors;
      errors.BeginFold();
      const double at_last = powers == misjudged && fold >= 2 ? 0.5 : 1;
      for (size_t place = 0; place < 8; ++place) errors.Add(place, at_last * places[place]);
    }
    if (powers == misjudged) ++finished;
    return errors;
  };
  EXPECT_EQ(Best(SearchSpreads(errors_of)), misjudged);
  EXPECT_EQ(finished, 1);
}

TEST(SpreadSearch, OneThatPredictsFarBetterIsTaken) {
  const SpreadFactors factors =
      ProbableFactors({{{1, -2, 0, -3, 2}, 0}, {{0, -2, 0, -3, 2}, 300}, {{1, -2, 0, -3, 1}, 300}});
  const SpreadFactors expected = {2, 0.25, 1, 0.125, 4, 1};
  for (size_t i = 0; i < kSpreadKinds; ++i) EXPECT_NEAR(factors[i], expected[i], 1e-9) << i;
}

// Which way is taken to the best rounding decides, and it must not decide what is taken.
TEST(SpreadSearch, OnlyWhatLiesAroundTheBestCounts) {
  Places at(kMany);
  const auto tried = SearchSpreads([&](const SpreadPowers& p, const GiveUp&) {
    return at(Bowl(p, {-1, -3, 0, -2, 0}, 0.08));
  });
  for (const TriedSpreads& one : tried) {
    int differing = 0;
    for (size_t i = 0; i < kSpreadKinds; ++i) differing += one.powers[i] != Best(tried)[i];
    EXPECT_LE(differing, 1);
  }
}

TEST(SpreadSearch, AllThatMayBeProbableIsTried) {
  const auto farthest = [](size_t places) {
    Places at(places);
    const auto tried = SearchSpreads([&](const SpreadPowers& p, const GiveUp&) {
      return at(1 + 0.1 * Bowl(p, {0, 0, 0, -3, 0}, 0));
    });
    int most = 0;
    for (const TriedSpreads& one : tried) {
      most = std::max(most, one.powers[kDiffuseSpread] - Best(tried)[kDiffuseSpread]);
    }
    return most;
  };
  EXPECT_EQ(farthest(kMany), 1);  // the first that is improbable
  EXPECT_EQ(farthest(100), 2);    // energies of about 1 and 16
}

TEST(SpreadSearch, WhatIsAsLikelyCountsAsMuch) {
  const SpreadFactors factors =
      ProbableFactors({{{-1, 0, 0, -1, 0}, 0}, {{1, 0, 0, -1, 0}, 0}, {{-1, 0, 0, 1, 0}, 30}});
  EXPECT_NEAR(factors[kRoughnessSpread], 1.25, 1e-12);
  EXPECT_NEAR(factors[kDiffuseSpread], 0.5, 1e-12);
}

// What a texel's rendering differs by in two photographs, the second 20 % brighter than stated.
std::vector<ViewDifferences> BrighterSecond(float scatter) {
  std::vector<ViewDifferences> texels;
  for (int t = 0; t < 100; ++t) {
    const float off = t % 2 == 0 ? scatter : -scatter;
    texels.push_back({std::array{off, off, off}, std::array{off - 0.2f, off - 0.2f, off - 0.2f}});
  }
  return texels;
}

double Sum(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0);
}

TEST(SquaresOf, AnUnknownExposureIsNoErrorOfTheMaps) {
  const auto right = [](float scatter) {
    return Sum(SquaresOf(BrighterSecond(scatter), 0.1, true));
  };
  EXPECT_NEAR(right(0), 0, 1e-9);
  EXPECT_NEAR(right(0.02f), 600 * 0.02 * 0.02, 0.02 * 600 * 0.02 * 0.02);
  EXPECT_GT(Sum(SquaresOf(BrighterSecond(0), 0.1, false)), 300 * 0.02);
}

TEST(SquaresOf, WhatAViewDoesNotShowCountsNothing) {
  std::vector<ViewDifferences> texels = BrighterSecond(0.02f);
  const std::vector<double> before = SquaresOf(texels, 0.1, true);
  texels[3] = {std::nullopt, std::nullopt};
  const std::vector<double> after = SquaresOf(texels, 0.1, true);
  EXPECT_EQ(after[3], 0);
  EXPECT_NEAR(after[4], before[4], 0.1 * before[4]);
}

HeldOutErrors ErrorsOf(const std::vector<std::vector<double>>& by_fold_and_place) {
  HeldOutErrors errors(by_fold_and_place.front().size());
  for (const auto& fold : by_fold_and_place) {
    errors.BeginFold();
    for (size_t place = 0; place < fold.size(); ++place) errors.Add(place, fold[place]);
  }
  return errors;
}

TEST(HeldOutErrors, TheWorseHasTheEnergyTheBetterLacks) {
  const HeldOutErrors a = ErrorsOf({{1, 2, 3}, {2, 2, 1}}), b = ErrorsOf({{1, 1, 3}, {2, 1, 1}});
  EXPECT_GT(a.EnergyAgainst(b), 0);
  EXPECT_NEAR(a.EnergyAgainst(b), -b.EnergyAgainst(a), 1e-9);
  EXPECT_EQ(a.EnergyAgainst(a), 0);
}

TEST(HeldOutErrors, AreComparedByTheFoldsThatBothHave) {
  const HeldOutErrors half = ErrorsOf({{1, 2, 3}, {2, 2, 1}});
  const HeldOutErrors other_half = ErrorsOf({{1, 1, 3}, {2, 1, 1}});
  const HeldOutErrors whole = ErrorsOf({{1, 1, 3}, {2, 1, 1}, {9, 9, 9}});
  EXPECT_EQ(half.EnergyAgainst(whole), half.EnergyAgainst(other_half));
  EXPECT_EQ(whole.EnergyAgainst(half), other_half.EnergyAgainst(half));
}

// The same sums: 12 against 9.
TEST(HeldOutErrors, WhatAllPlacesAndPhotographsSayIsSurerThanWhatOneSays) {
  const HeldOutErrors best = ErrorsOf({{1, 1, 1}, {1, 1, 1}, {1, 1, 1}});
  const double all =
      ErrorsOf({{1.4, 1.3, 1.3}, {1.3, 1.4, 1.3}, {1.3, 1.3, 1.4}}).EnergyAgainst(best);
  const double place = ErrorsOf({{2, 1, 1}, {2, 1, 1}, {2, 1, 1}}).EnergyAgainst(best);
  const double fold = ErrorsOf({{2, 2, 2}, {1, 1, 1}, {1, 1, 1}}).EnergyAgainst(best);
  EXPECT_GT(all, 100 * place);
  EXPECT_NEAR(place, fold, 1e-12);
}

// Errors that scatter by so much say which of two spreads they come from as firmly as they should:
// where the two differ by chance alone, the energy is about one.
TEST(HeldOutErrors, ChanceAloneLeavesBothProbable) {
  std::mt19937 random(3);
  std::normal_distribution<double> scatter(1, 0.2);
  int firm = 0;
  constexpr int kTrials = 400;
  for (int i = 0; i < kTrials; ++i) {
    std::vector<std::vector<double>> a(7, std::vector<double>(50)), b = a;
    for (auto* errors : {&a, &b}) {
      for (auto& fold : *errors) {
        for (double& one : fold) one = scatter(random);
      }
    }
    firm += std::abs(ErrorsOf(a).EnergyAgainst(ErrorsOf(b))) > 3;
  }
  EXPECT_LT(firm, 0.2 * kTrials);
}

}  // namespace
}  // namespace glint
