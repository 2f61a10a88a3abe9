#include "fitting/refine/residual_model.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "tests/fitting/refine/synthetic_scene.h"

namespace glint {
namespace {

using test::Photograph;
using test::QuarteredMaps;
using test::SyntheticScene;

TEST(DistinctViews, FromOnePlaceAreOneAndSpreadOnesMore) {
  const SyntheticScene scene = Photograph(QuarteredMaps(4, 25), 1);
  RefineProblem problem = scene.Problem();
  for (int i = 0; i < 4; ++i) problem.views.push_back(problem.views[0]);
  EXPECT_NEAR(DistinctViews(problem), 1.0, 1e-9);
  const double distinct = DistinctViews(Photograph(QuarteredMaps(4, 25), 5).Problem());
  EXPECT_GT(distinct, 2.0);
  EXPECT_LT(distinct, 5.0);
}

TEST(ResidualModel, NoiseIsEachViewsAndChannelsOwn) {
  const SyntheticScene scene = Photograph(QuarteredMaps(8, 1), 6, 8);
  ResidualModel model(scene.Problem(), {});
  model.SetVariance(0);  // raised to what measuring adds
  EXPECT_NEAR(model.discrepancy(), 0, 1e-9);
  EXPECT_NEAR(model.effective_views(), 6, 1e-9);
  EXPECT_NEAR(model.scale() * model.scale(), model.variance(), 1e-12);
}

TEST(ResidualModel, DiscrepancyMakesResidualsSayLess) {
  const SyntheticScene scene = Photograph(QuarteredMaps(8, 1), 6, 8);
  ResidualModel model(scene.Problem(), {});
  double last_views = 7, last_scale = 0;
  for (const double sigma : {0.02, 0.05, 0.2}) {
    model.SetVariance(sigma * sigma);
    EXPECT_LT(model.effective_views(), last_views);
    EXPECT_GE(model.effective_views(), 1);
    EXPECT_GT(model.scale(), sigma);
    EXPECT_GT(model.scale(), last_scale);
    last_views = model.effective_views();
    last_scale = model.scale();
  }
}

TEST(ResidualModel, PhotographsFromOnePlaceSayLittleMoreThanOne) {
  const SyntheticScene scene = Photograph(QuarteredMaps(4, 25), 1, 8);
  RefineProblem problem = scene.Problem();
  for (int i = 0; i < 7; ++i) problem.views.push_back(problem.views[0]);
  ResidualModel model(problem, {});
  model.SetVariance(0.04);
  EXPECT_LT(model.effective_views(), 1.3);
}

// Rounding to 8 bits, measured: radiance of random codes' middles.
TEST(MeasurementVariance, IsThatOfRoundedRadiance) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> code(20, 250);
  const int n = 20000;
  std::vector<float> rgb(3 * n), mask(n, 1.0f);
  double squares = 0;
  for (int i = 0; i < n; ++i) {
    const double exact = code(random);
    const double truth = std::pow(exact / 255, 2.2), seen = std::pow(std::round(exact) / 255, 2.2);
    for (int c = 0; c < 3; ++c) rgb[c * n + i] = static_cast<float>(seen);
    const double residual = std::log(seen + 0.01) - std::log(truth + 0.01);
    squares += residual * residual / n;
  }
  RefineProblem problem;
  problem.views.push_back({DirView(0, 0), true, rgb, mask});
  const double sensor = 0.003 * 0.003;
  EXPECT_NEAR(MeasurementVariance(problem) - sensor, squares, 0.05 * squares);
}

// Draws of density ∝ exp(−g²(x)/2σ²) by rejection: the estimate is σ².
TEST(HyperbolicVariance, IsTheLikelihoodsMaximumAndTellsMeanSquares) {
  std::mt19937 random(4);
  const double delta = 0.1;
  for (const double sigma : {0.02, 0.1, 0.2}) {
    std::uniform_real_distribution<double> place(-20 * sigma * std::max(1.0, sigma / delta),
                                                 20 * sigma * std::max(1.0, sigma / delta)),
        height(0, 1);
    double sum = 0, squares = 0;
    int n = 0;
    while (n < 20000) {
      const double x = place(random);
      const double g2 = 2 * delta * delta * (std::sqrt(1 + x * x / delta / delta) - 1);
      if (height(random) > std::exp(-0.5 * g2 / (sigma * sigma))) continue;
      sum += g2;
      squares += x * x;
      ++n;
    }
    EXPECT_NEAR(HyperbolicVariance(sum / n, delta), sigma * sigma, 0.05 * sigma * sigma) << sigma;
    EXPECT_NEAR(HyperbolicMeanSquare(sigma * sigma, delta), squares / n, 0.05 * squares / n)
        << sigma;
  }
  // Short tails: Gauss's.
  EXPECT_NEAR(HyperbolicMeanSquare(1e-6, delta), 1e-6, 1e-9);
  EXPECT_EQ(HyperbolicMeanSquare(0, delta), 0);
}

}  // namespace
}  // namespace glint
