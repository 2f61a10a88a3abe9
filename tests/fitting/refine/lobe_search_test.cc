// Whether a sample has a second specular lobe, by how well photographs held out are predicted.
#include "fitting/refine/lobe_search.h"

#include <gtest/gtest.h>

#include <cmath>

#include "fitting/refine/refine.h"
#include "tests/fitting/refine/synthetic_scene.h"

namespace glint {
namespace {

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
  const SpecularLobes found = SearchLobes([&](const SpecularLobes& lobes) {
    ++tried;
    return Errors(lobes.two() ? 1.01 : 1);
  });
  EXPECT_EQ(found, SpecularLobes());
  EXPECT_EQ(tried, 2);  // one lobe, and the nearest two
}

TEST(LobeSearch, WalksToThoseThatPredictBest) {
  const SpecularLobes found = SearchLobes([](const SpecularLobes& lobes) {
    const double share = lobes.narrow_share - 0.7, ratio = std::log(lobes.narrow_ratio / 0.25);
    return Errors(1 + share * share + ratio * ratio);
  });
  EXPECT_EQ(found, (SpecularLobes{0.7, 0.25}));
}

// One photograph that is predicted better does not say that there are two.
TEST(LobeSearch, TwoLobesMustPredictClearlyBetter) {
  const SpecularLobes found = SearchLobes([](const SpecularLobes& lobes) {
    HeldOutErrors errors(4);
    for (size_t fold = 0; fold < 3; ++fold) {
      errors.BeginFold();
      for (size_t place = 0; place < 4; ++place) {
        errors.Add(place, lobes.two() && fold == 0 ? 0.8 : 1);
      }
    }
    return errors;
  });
  EXPECT_EQ(found, SpecularLobes());
}

// Refinement of a level sample, of nine photographs, from maps that are off.
RefineResult Refined(const SpecularLobes& lobes, const RefineOptions& options) {
  const SvbrdfMaps truth = test::LevelSubstance(24, 0.4f);
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

TEST(Refine, ASampleOfOneLobeKeepsIt) { EXPECT_FALSE(Refined({}, {}).summary.lobes.two()); }

}  // namespace
}  // namespace glint
