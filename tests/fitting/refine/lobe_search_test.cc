// What specular lobes a sample has, by how well photographs held out are predicted.
#include "fitting/refine/lobe_search.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "base/model/estimate.h"
#include "fitting/refine/refine.h"
#include "tests/fitting/refine/synthetic_scene.h"

namespace glint {
namespace {

constexpr double kCoatF0 = 0.04;

// Folds and places that all agree, but for a little.
HeldOutErrors Errors(double sum) {
  HeldOutErrors errors(4);
  for (size_t fold = 0; fold < 3; ++fold) {
    errors.BeginFold();
    for (size_t place = 0; place < 4; ++place) {
      errors.Add(place, sum / 12 * (1 + 0.01 * static_cast<double>((fold + 2 * place) % 3)));
    }
  }
  return errors;
}

TEST(LobeSearch, OneLobeIsKeptWhereTwoPredictNoBetter) {
  int tried = 0;
  const auto found = SearchLobes(kCoatF0, [&](const SpecularLobes& lobes) {
    ++tried;
    return Errors(lobes.two() ? 1.01 : 1);
  });
  EXPECT_TRUE(found.empty());
  EXPECT_EQ(tried, 3);  // one lobe, and the nearest two of each kind
}

TEST(LobeSearch, WalksToThoseThatPredictBest) {
  const auto found = SearchLobes(kCoatF0, [](const SpecularLobes& lobes) {
    const double share = lobes.narrow_share - 0.7, ratio = std::log(lobes.narrow_ratio / 0.25);
    return Errors((lobes.coat_f0 > 0 ? 0.9 : 1) + share * share + ratio * ratio);
  });
  EXPECT_EQ(found, (std::vector<SpecularLobes>{{0.7, 0.25, kCoatF0}, {0.7, 0.25}}));
}

TEST(LobeSearch, AKindThatPredictsNoBetterIsLeftOut) {
  const auto found = SearchLobes(kCoatF0, [](const SpecularLobes& lobes) {
    return Errors(lobes.coat_f0 > 0 ? 1.01 : lobes.two() ? 0.5 : 1);
  });
  EXPECT_EQ(found, (std::vector<SpecularLobes>{{0.5, 0.6}}));
}

// One photograph that is predicted better does not say that there are two.
TEST(LobeSearch, TwoLobesMustPredictClearlyBetter) {
  const auto found = SearchLobes(kCoatF0, [](const SpecularLobes& lobes) {
    HeldOutErrors errors(4);
    for (size_t fold = 0; fold < 3; ++fold) {
      errors.BeginFold();
      for (size_t place = 0; place < 4; ++place) {
        errors.Add(place, lobes.two() && fold == 0 ? 0.8 : 1);
      }
    }
    return errors;
  });
  EXPECT_TRUE(found.empty());
}

// Refinement of a level sample, of nine photographs, from maps that are off.
RefineResult Refined(const SpecularLobes& lobes, const RefineOptions& options,
                     const std::array<float, 3>& specular_tint = {1, 1, 1}) {
  SvbrdfMaps truth = test::LevelSubstance(24, 0.4f);
  for (int c = 0; c < 3; ++c) {
    for (float& f0 : truth.plane(kSpecularR + c)) f0 *= specular_tint[static_cast<size_t>(c)];
  }
  const test::SyntheticScene scene = test::Photograph(truth, 9, 0, 5, {}, lobes);
  return Refine(scene.Problem(), test::DisturbedMaps(truth, 0.5f, 3), options, 2);
}

TEST(Refine, AVarnishedSampleHasItsTwoLobes) {
  const SpecularLobes truth = {0.5, 0.4};
  const RefineResult found = Refined(truth, {});
  ASSERT_TRUE(found.summary.lobes.two());
  EXPECT_NEAR(found.summary.lobes.narrow_share, truth.narrow_share, 0.21);
  RefineOptions one;
  one.second_lobe = false;
  const RefineResult single = Refined(truth, one);
  EXPECT_FALSE(single.summary.lobes.two());
  EXPECT_LT(found.summary.residual_sigma, 0.8 * single.summary.residual_sigma);
  const auto roughness = found.maps.plane(kRoughness);
  double mean = 0;
  for (const float value : roughness) mean += value / static_cast<double>(roughness.size());
  EXPECT_NEAR(mean, 0.4, 0.03);
}

// The substance's own F0 is coloured, the coat's highlight is white.
TEST(Refine, ACoatedSampleHasItsCoat) {
  const SpecularLobes truth = {0.3, 0.4, 0.04};
  const RefineResult found = Refined(truth, {}, {1.5f, 1.0f, 0.3f});
  ASSERT_TRUE(found.summary.lobes.two());
  EXPECT_GT(found.summary.lobes.coat_f0, 0);
  EXPECT_NEAR(found.summary.lobes.narrow_share, truth.narrow_share, 0.21);
}

TEST(Refine, ASampleOfOneLobeOfGgxKeepsIt) {
  RefineOptions options;
  options.lobe_tails = true;
  EXPECT_EQ(Refined({}, options).summary.lobes, SpecularLobes());
}

TEST(Refine, ASampleWhoseLobeFallsOffFasterThanGgxHasShorterTails) {
  const SpecularLobes truth = {.tail_exponent = 4};
  RefineOptions options;
  options.lobe_tails = true;
  const RefineResult found = Refined(truth, options);
  EXPECT_FALSE(found.summary.lobes.two());
  EXPECT_EQ(found.summary.lobes.tail_exponent, truth.tail_exponent);
  const RefineResult as_ggx = Refined(truth, {});
  EXPECT_EQ(as_ggx.summary.lobes.tail_exponent, 2);
  EXPECT_LT(found.summary.residual_sigma, as_ggx.summary.residual_sigma);
}

TEST(RoughnessSearch, WalksToTheRoughnessThatPredictsBest) {
  for (const double best : constants::kRoughnessLevels) {
    const auto found = SearchRoughness(Errors(1.1), [&](double roughness) {
      return Errors(1 + std::abs(std::log(roughness / best)));
    });
    EXPECT_EQ(found, best);
  }
}

TEST(RoughnessSearch, NoneIsTakenWhereNonePredictsBetter) {
  int tried = 0;
  const auto found = SearchRoughness(Errors(1), [&](double roughness) {
    ++tried;
    return Errors(1 + roughness);
  });
  EXPECT_FALSE(found);
  EXPECT_EQ(tried, 3);  // the first and its neighbours
}

TEST(AnisotropySearch, WalksToTheDirectionAndRatioThatPredictBest) {
  const double ratio = 2.2, direction_rad = 100 * std::numbers::pi / 180;
  const Anisotropy found = SearchAnisotropy([&](const Anisotropy& anisotropy) {
    // Opposite directions are the same.
    const double here_rad = anisotropy.direction_deg * std::numbers::pi / 180;
    const double log_here = std::log(anisotropy.ratio), log_there = std::log(ratio);
    return Errors(
        1 +
        std::hypot(log_here * std::cos(2 * here_rad) - log_there * std::cos(2 * direction_rad),
                   log_here * std::sin(2 * here_rad) - log_there * std::sin(2 * direction_rad)));
  });
  EXPECT_NEAR(std::log(found.ratio), std::log(ratio), 0.15);
  EXPECT_NEAR(found.direction_deg, 100, 6);
}

TEST(AnisotropySearch, RoundLobesStayRoundAfterFourTrials) {
  int tried = 0;
  const Anisotropy found = SearchAnisotropy([&](const Anisotropy& anisotropy) {
    ++tried;
    return Errors(anisotropy.any() ? 1.01 : 1);
  });
  EXPECT_FALSE(found.any());
  EXPECT_EQ(tried, 5);
}

TEST(Refine, ABrushedSampleHasAnisotropicLobes) {
  const SpecularLobes truth = {.anisotropy = {2.25, 30}};
  const RefineResult found = Refined(truth, {});
  EXPECT_NEAR(std::log(found.summary.lobes.anisotropy.ratio), std::log(2.25), 0.3);
  EXPECT_NEAR(found.summary.lobes.anisotropy.direction_deg, 30, 10);
  EXPECT_FALSE(found.summary.lobes.two());
  RefineOptions isotropic;
  isotropic.anisotropy = false;
  const RefineResult as_round = Refined(truth, isotropic);
  EXPECT_FALSE(as_round.summary.lobes.anisotropy.any());
  EXPECT_LT(found.summary.residual_sigma, 0.8 * as_round.summary.residual_sigma);
}

}  // namespace
}  // namespace glint
