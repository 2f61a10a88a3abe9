#include "fitting/refine/kinds_prior.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <vector>

namespace glint {
namespace {

SpecularMean Grey(double f0) { return SpecularMean::Constant(f0); }

// Where Newton steps on the prior alone end.
std::vector<SpecularMean> MostProbable(std::vector<SpecularMean> means,
                                       const KindsPriorOptions& options) {
  for (int step = 0; step < 50; ++step) {
    const KindsPrior prior = PriorOfKinds(means, options);
    const Eigen::VectorXd by = prior.information.ldlt().solve(prior.gradient);
    for (size_t k = 0; k < means.size(); ++k) {
      means[k] += by.segment<3>(3 * static_cast<Eigen::Index>(k));
      means[k] = means[k].cwiseMax(1e-4);
    }
  }
  return means;
}

TEST(KindsPrior, SubstancesAreDrawnToOneKindOrTheOther) {
  const std::vector<SpecularMean> found =
      MostProbable({Grey(0.1), Grey(0.015), Grey(0.8), SpecularMean(0.9, 0.6, 0.3)}, {});
  for (const size_t dielectric : {0u, 1u}) {
    EXPECT_NEAR(found[dielectric].mean(), 0.04, 0.003) << dielectric;
  }
  for (const size_t metal : {2u, 3u}) EXPECT_GT(found[metal].mean(), 0.4) << metal;
}

TEST(KindsPrior, OnlyMetalsAreColoured) {
  const auto pull = [](double f0, double colour) {
    const KindsPrior prior =
        PriorOfKinds({SpecularMean((1 + colour) * f0, f0, (1 - colour) * f0)}, {});
    // Towards grey, by relative changes and relative to the colour.
    return (prior.gradient[2] - prior.gradient[0]) * f0 / colour;
  };
  EXPECT_GT(pull(0.04, 0.1), 20 * pull(0.5, 0.3));
}

// Strong colour is what the model leaves over of light from beneath the surface, not metal.
TEST(KindsPrior, ColouredSubstancesThatReflectFewPerCentAreNoMetals) {
  const std::vector<SpecularMean> found = MostProbable({SpecularMean(0.06, 0.045, 0.02)}, {});
  EXPECT_LT(found[0].maxCoeff(), 0.08);
}

// All of a sample that is twice as bright as dielectrics are lies under a light that is half as
// strong as thought, where its power is not known; one of them that is stays improbable.
TEST(KindsPrior, WhereTheLightsPowerIsNotKnownSubstancesAreOffTogether) {
  const auto pull_on_first = [](double second, double power_spread) {
    const KindsPrior prior = PriorOfKinds({Grey(0.08), Grey(second), Grey(second), Grey(second)},
                                          {.light_power_spread = power_spread});
    return -prior.gradient[0];
  };
  EXPECT_LT(pull_on_first(0.08, 1.0), 0.2 * pull_on_first(0.08, 0.05));
  EXPECT_GT(pull_on_first(0.04, 1.0), 0.7 * pull_on_first(0.04, 0.05));
}

TEST(KindsPrior, CountsSubstancesThatAreProbablyMetals) {
  EXPECT_NEAR(PriorOfKinds({Grey(0.04), Grey(0.03), Grey(0.7), SpecularMean(0.9, 0.6, 0.3)}, {})
                  .metal_share,
              0.5, 0.02);
}

TEST(KindsPrior, BetweenTheKindsTheShareOfMetalsDecides) {
  const auto found = [](double metal_share) {
    return MostProbable({Grey(0.12)}, {.metal_share = metal_share})[0].mean();
  };
  EXPECT_LT(found(0.1), 0.05);
  EXPECT_GT(found(0.9), 0.4);
}

}  // namespace
}  // namespace glint
