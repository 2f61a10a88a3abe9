#include "fitting/view_correction/sampled_texels.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <cmath>
#include <memory>

#include "fitting/view_correction/view_priors.h"
#include "tests/fitting/view_correction/disturbed_set.h"

namespace glint {
namespace {

using Eigen::VectorXd;

constexpr int kViews = 6;
constexpr int kTerms = 16;  // of the environment lighting

// Corrections of every kind.
VectorXd SomeCorrections(const ViewUnknowns& unknowns) {
  VectorXd x(unknowns.size());
  for (int i = 0; i < x.size(); ++i) x[i] = 0.02 * std::sin(2.3 * i + 1);
  for (int c = 0; c < 3; ++c) x[unknowns.environment(c)] = 0.05 + 0.01 * c;
  for (int v = 0; unknowns.kinds().registration && v < unknowns.views(); ++v) {
    for (int i = 0; i < 8; ++i) x[unknowns.shift(v) + i] *= 10;
  }
  return x;
}

// Sampled texels that follow the views closely.
struct Case {
  explicit Case(bool inverse_square, bool registration = true, double residual_sigma = 0.02)
      : disturbed(test::Disturb(kViews, 0.05, 0.3, true)) {
    if (inverse_square) {
      disturbed.set.convention = {DiffuseWeight::kOneMinusSpecular, LightFalloff::kInverseSquare,
                                  TexelSampling::kPixelCentres};
      for (Photograph& p : disturbed.set.photographs) {
        for (double& power : p.view.light_rgb) power *= 5;
      }
    }
    unknowns = std::make_unique<ViewUnknowns>(disturbed.set,
                                              UnknownKinds{true, true, registration, kTerms});
    sampled = std::make_unique<SampledTexels>(disturbed.set, disturbed.maps, *unknowns, 36, 0.1, 1);
    sampled->SetResidualSigma(residual_sigma);
    x = SomeCorrections(*unknowns);
    values = sampled->Starts();
    for (int i = 0; i < 4; ++i) cost = sampled->Fit(x, nullptr, &values);
  }
  double CostAt(const VectorXd& at) {
    SampledTexels::Values fitted = values;
    double least = 0;
    for (int i = 0; i < 3; ++i) least = sampled->Fit(at, nullptr, &fitted);
    return least;
  }
  test::DisturbedSet disturbed;
  std::unique_ptr<ViewUnknowns> unknowns;
  std::unique_ptr<SampledTexels> sampled;
  VectorXd x;
  SampledTexels::Values values;
  double cost = 0;
};

TEST(SampledTexels, TheGradientIsThatOfTheCostOfTexelsFittedAnew) {
  for (const bool inverse_square : {false, true}) {
    // Held so firmly that no texel jumps to another minimum.
    Case c(inverse_square, true, 0.2);
    const VectorXd gradient = c.sampled->Reduce(c.x, c.values).gradient;
    for (int i = 0; i < c.unknowns->size(); ++i) {
      const double step = i < c.unknowns->first_shift() ? 1e-3 : 1e-2;
      VectorXd above = c.x, below = c.x;
      above[i] += step;
      below[i] -= step;
      const double difference = (c.CostAt(above) - c.CostAt(below)) / (2 * step);
      EXPECT_NEAR(gradient[i], difference, 0.02 * std::abs(difference) + 0.003 * gradient.norm())
          << "unknown " << i << " of " << c.unknowns->size();
    }
  }
}

// One Gauss–Newton step of the views from near the truth takes most of the cost away.
TEST(SampledTexels, AStepOfTheReducedEquationsLowersTheCost) {
  Case c(false);
  NormalEquations equations = c.sampled->Reduce(c.x, c.values);
  ViewExpectations wide;
  wide.light = wide.distance = wide.ambient = wide.exposure = 1;
  ViewPriors(*c.unknowns, wide, c.sampled->UsableViews()).Add(c.x, &equations);
  const VectorXd step = -equations.hessian.ldlt().solve(equations.gradient);
  SampledTexels::Values followed = c.sampled->Follow(step, c.values);
  EXPECT_LT(c.sampled->Fit(c.x + step, nullptr, &followed), 0.5 * c.cost);
}

// Texels are summed in batches within pieces: none, some, and just as many as fill them.
TEST(SampledTexels, AnyNumberOfTexelsIsReducedByAnyNumberOfThreads) {
  const test::DisturbedSet disturbed = test::Disturb(2, 0.05, 0.3, false);
  const ViewUnknowns unknowns(disturbed.set, {});
  const VectorXd x = VectorXd::Zero(unknowns.size());
  for (const int texels : {1, 4, 36, 144, 3600}) {
    SampledTexels one(disturbed.set, disturbed.maps, unknowns, texels, 0.1, 1);
    SampledTexels sampled(disturbed.set, disturbed.maps, unknowns, texels, 0.1, 3);
    const NormalEquations equations = sampled.Reduce(x, sampled.Starts());
    EXPECT_TRUE(equations.hessian.allFinite()) << sampled.size();
    EXPECT_GT(equations.gradient.norm(), 0) << sampled.size();
    EXPECT_EQ(equations.hessian, one.Reduce(x, one.Starts()).hessian) << sampled.size();
  }
}

TEST(SampledTexels, TexelsAndTheirMeanSlopeFollowAsPredicted) {
  Case c(false, false);
  c.sampled->Reduce(c.x, c.values);
  VectorXd step = VectorXd::Zero(c.unknowns->size());
  for (int v = 0; v < kViews; ++v) step[c.unknowns->light(v)] = 0.01;
  const SampledTexels::Values followed = c.sampled->Follow(step, c.values);
  SampledTexels::Values fitted = c.values;
  for (int i = 0; i < 3; ++i) c.sampled->Fit(c.x + step, nullptr, &fitted);
  double missed = 0, moved = 0;
  for (size_t k = 0; k < fitted.size(); ++k) {
    for (int i = kSlopeX; i <= kSlopeY; ++i) {
      const size_t slope = static_cast<size_t>(i);
      missed += std::abs(fitted[k][slope] - followed[k][slope]);
      moved += std::abs(fitted[k][slope] - c.values[k][slope]);
    }
  }
  EXPECT_LT(missed, 0.2 * moved);
  const Eigen::Vector2d predicted = c.sampled->MeanSlopeByViews() * step;
  const Eigen::Vector2d actual = c.sampled->MeanSlope(fitted) - c.sampled->MeanSlope(c.values);
  EXPECT_NEAR(predicted[0], actual[0], 0.1 * std::abs(actual[0]));
}

TEST(ViewPriors, TheGradientIsThatOfTheCost) {
  Case c(false);
  const ViewPriors priors(*c.unknowns, {}, c.sampled->UsableViews());
  NormalEquations equations(c.unknowns->size());
  const double cost = priors.Add(c.x, &equations);
  EXPECT_DOUBLE_EQ(cost, priors.Add(c.x, nullptr));
  for (int i = 0; i < c.unknowns->size(); ++i) {
    VectorXd above = c.x, below = c.x;
    above[i] += 1e-5;
    below[i] -= 1e-5;
    const double difference = (priors.Add(above, nullptr) - priors.Add(below, nullptr)) / 2e-5;
    EXPECT_NEAR(equations.gradient[i], difference, 1e-5 * equations.gradient.norm()) << i;
  }
}

// Lights that are off together cost their common offset alone, whatever their directions.
TEST(ViewPriors, ASharedOffsetCostsOnce) {
  Case c(false, false);
  const ViewPriors priors(*c.unknowns, {}, c.sampled->UsableViews());
  VectorXd shared = VectorXd::Zero(c.unknowns->size());
  shared[c.unknowns->shared_light()] = 0.1;
  for (int v = 0; v < kViews; ++v) {
    const Vec3d d = c.unknowns->LightDirection(v);
    const Eigen::Vector3d direction(d[0], d[1], d[2]);
    shared.segment<3>(c.unknowns->light(v)) =
        Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitZ(), direction) *
        Eigen::Vector3d(0.1, 0, 0);
  }
  EXPECT_NEAR(priors.Add(shared, nullptr), 0.5 * (0.1 / 0.3) * (0.1 / 0.3), 1e-9);
  EXPECT_EQ(priors.Learned(shared, {}).light, ViewExpectations{}.light);
  VectorXd own = VectorXd::Zero(c.unknowns->size());
  for (int v = 0; v < kViews; ++v) own[c.unknowns->light(v) + 1] = v % 2 == 0 ? 0.2 : -0.2;
  EXPECT_GT(priors.Learned(own, {}).light, 0.08);
}

}  // namespace
}  // namespace glint
