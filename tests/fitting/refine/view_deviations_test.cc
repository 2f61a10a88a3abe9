// The views' normal equations, texels eliminated.
#include "fitting/refine/view_deviations.h"

#include <gtest/gtest.h>

#include <random>
#include <vector>

namespace glint {
namespace {

constexpr int kViews = 3;
constexpr size_t kTexels = 600;  // several pieces of work

// Texels that show all views, residuals of which follow log exposures alone, without what texels'
// values could take of them unless `by_values`.
struct Texels {
  explicit Texels(const std::array<double, kViews>& log_exposures, float by_values = 0) {
    std::mt19937 random(7);
    std::normal_distribution<float> normal;
    products.resize(kTexels);
    inverses.resize(kTexels);
    for (size_t t = 0; t < kTexels; ++t) {
      for (size_t k = 0; k < kTexelParameters; ++k) inverses[t][k * (kTexelParameters + 1)] = 0.1;
      for (int view = 0; view < kViews; ++view) {
        DeviationProducts& of = products[t].emplace_back();
        of.view = view;
        of.squared[kLogExposure][kLogExposure] = 1;
        of.by_residual[kLogExposure] =
            static_cast<float>(-log_exposures[static_cast<size_t>(view)]);
        for (float& value : of.by_values[kLogExposure]) value = by_values * normal(random);
        for (float& by : of.by_shared) by = normal(random);
      }
      TexelOfViews& texel = texels.emplace_back();
      texel.place = {normal(random), normal(random)};
      texel.slope = {normal(random), normal(random)};
      texel.inverse = inverses[t].data();
      texel.products = &products[t];
    }
  }

  std::vector<std::vector<DeviationProducts>> products;
  std::vector<std::array<double, kTexelParameters * kTexelParameters>> inverses;
  std::vector<TexelOfViews> texels;
};

DeviationValues ExposuresUnknown() {
  DeviationValues expected{};
  expected[kLogExposure] = 0.2;
  return expected;
}

TEST(ViewDeviations, FindsExposuresThatResidualsFollow) {
  const std::array<double, kViews> truth = {0.05, -0.08, 0.03};
  ViewDeviations deviations(kViews, ExposuresUnknown(), {});
  deviations.Update(Texels(truth).texels, 1e6, 1);
  for (size_t v = 0; v < kViews; ++v) {
    EXPECT_NEAR(deviations.values()[v][kLogExposure], truth[v], 1e-4) << v;
  }
}

// What a shared value does is a factor on the deviation that it shows itself as.
TEST(ViewDeviations, FindsASharedValueBehindExposures) {
  Texels texels({});
  for (auto& of_texel : texels.products) {
    for (DeviationProducts& of : of_texel) {
      of.by_residual[kLogExposure] = -0.07f * of.by_shared[kDistancePower];
    }
  }
  SharedLightValues expected{};
  expected[kDistancePower] = 1;
  ViewDeviations deviations(kViews, {}, expected);
  deviations.Update(texels.texels, 1e6, 1);
  EXPECT_NEAR(deviations.shared()[kDistancePower], 0.07, 1e-4);
}

TEST(ViewDeviations, AreTheSameForAnyNumberOfThreads) {
  SharedLightValues expected{};
  expected[kBeamX] = expected[kDistancePower] = 0.3;
  const Texels texels({0.05, -0.08, 0.03}, 0.5f);
  ViewDeviations one(kViews, ExposuresUnknown(), expected), three(one);
  one.Update(texels.texels, 100, 1);
  three.Update(texels.texels, 100, 3);
  EXPECT_EQ(one.values(), three.values());
  EXPECT_EQ(one.shared(), three.shared());
  EXPECT_NE(one.values()[0][kLogExposure], 0);
}

}  // namespace
}  // namespace glint
