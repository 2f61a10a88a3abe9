#include "fitting/refine/refine.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <numeric>

#include "fitting/refine/refine_prior.h"
#include "tests/fitting/refine/synthetic_scene.h"

namespace glint {
namespace {

using test::DisturbedMaps;
using test::MeanSquare;
using test::Photograph;
using test::QuarteredMaps;
using test::SyntheticScene;

// Share of texels whose value in `plane` is within `tolerance`.
double ShareWithin(const SvbrdfMaps& maps, const SvbrdfMaps& truth, int plane, double tolerance) {
  size_t within = 0;
  for (size_t t = 0; t < maps.texels(); ++t) {
    within += std::abs(maps.plane(plane)[t] - truth.plane(plane)[t]) <= tolerance;
  }
  return static_cast<double>(within) / static_cast<double>(maps.texels());
}

TEST(Refine, RecoversKnownMapsFromNoiseFreePhotographs) {
  const SyntheticScene scene = Photograph(QuarteredMaps(24, 1), 16);
  const SvbrdfMaps start = DisturbedMaps(scene.truth, 1.0f, 2);
  const RefineResult result = Refine(scene.Problem(), start, {}, 1);
  EXPECT_LT(MeanSquare(result.maps, scene.truth, kNormalX, kNormalZ), 1e-6);
  EXPECT_LT(MeanSquare(result.maps, scene.truth, kDiffuseR, kDiffuseB), 1e-6);
  // A narrow highlight that no view shows leaves specular and roughness open in a few texels.
  EXPECT_GT(ShareWithin(result.maps, scene.truth, kSpecularG, 1e-3), 0.95);
  EXPECT_GT(ShareWithin(result.maps, scene.truth, kRoughness, 1e-3), 0.95);
  EXPECT_LT(ShareWithin(start, scene.truth, kRoughness, 1e-3), 0.05);
}

// Fig. 16 of the paper: too rough with too little specular holds a single descent.
TEST(Refine, DoesNotInheritAWrongRoughness) {
  const SyntheticScene scene = Photograph(QuarteredMaps(16, 3), 16, 8);
  SvbrdfMaps start = scene.truth;
  for (float& r : start.plane(kRoughness)) r = std::min(2.5f * r, 0.95f);
  for (int c = 0; c < 3; ++c) {
    for (float& s : start.plane(kSpecularR + c)) s *= 0.3f;
  }
  RefineOptions once;
  once.starts = 1;
  once.neighbour_passes = 0;
  const RefineResult single = Refine(scene.Problem(), start, once, 1);
  const RefineResult several = Refine(scene.Problem(), start, {}, 1);
  EXPECT_LE(several.summary.final_cost, single.summary.final_cost);
  EXPECT_LT(MeanSquare(several.maps, scene.truth, kRoughness, kRoughness), 5e-3);
  EXPECT_GT(MeanSquare(start, scene.truth, kRoughness, kRoughness), 0.1);
}

TEST(Refine, NeverRaisesATexelsCost) {
  const SyntheticScene scene = Photograph(QuarteredMaps(16, 4), 3, 8);
  const SvbrdfMaps start = DisturbedMaps(scene.truth, 1.0f, 5);
  RefineOptions nothing;
  nothing.prior = 0.0;
  const RefineResult refined = Refine(scene.Problem(), start, nothing, 1);
  // What the result costs is what it costs as a start; texel by texel.
  RefineOptions single = nothing;
  single.iterations = 1;
  single.starts = 1;
  single.neighbour_passes = 0;
  const RefineResult before = Refine(scene.Problem(), start, single, 1);
  for (size_t t = 0; t < start.texels(); ++t) {
    EXPECT_LE(refined.confidence[kTexelCost * start.texels() + t],
              before.confidence[kTexelCost * start.texels() + t] * (1 + 1e-5f) + 1e-8f);
  }
  EXPECT_LT(refined.summary.final_cost, 0.1 * refined.summary.start_cost);
}

TEST(Refine, GivesTheSameBitsForAnyNumberOfThreads) {
  const SyntheticScene scene = Photograph(QuarteredMaps(40, 6), 5, 8);
  const SvbrdfMaps start = DisturbedMaps(scene.truth, 1.0f, 7);
  const RefineResult one = Refine(scene.Problem(), start, {}, 1);
  for (const int threads : {2, 3, 8}) {
    const RefineResult several = Refine(scene.Problem(), start, {}, threads);
    EXPECT_EQ(several.maps.planes, one.maps.planes);
    EXPECT_EQ(several.confidence, one.confidence);
    EXPECT_EQ(several.summary.final_cost, one.summary.final_cost);
    EXPECT_EQ(several.summary.view_loss, one.summary.view_loss);
  }
}

TEST(Refine, DoesNotDependOnTheOrderOfPhotographs) {
  const SyntheticScene scene = Photograph(QuarteredMaps(16, 8), 7, 8);
  const SvbrdfMaps start = DisturbedMaps(scene.truth, 1.0f, 9);
  RefineProblem problem = scene.Problem();
  const RefineResult forward = Refine(problem, start, {}, 1);
  std::reverse(problem.views.begin(), problem.views.end());
  const RefineResult backward = Refine(problem, start, {}, 1);
  EXPECT_EQ(forward.maps.planes, backward.maps.planes);
  std::vector<double> losses = backward.summary.view_loss;
  std::reverse(losses.begin(), losses.end());
  EXPECT_EQ(forward.summary.view_loss, losses);
}

TEST(Refine, LeavesMaskedTexelsOfAViewOut) {
  SyntheticScene scene = Photograph(QuarteredMaps(16, 10), 6, 8);
  const SvbrdfMaps start = DisturbedMaps(scene.truth, 1.0f, 11);
  const size_t texels = start.texels();
  std::fill(scene.masks[2].begin(), scene.masks[2].begin() + texels / 2, 0.0f);
  const RefineResult masked = Refine(scene.Problem(), start, {}, 1);
  for (int c = 0; c < 3; ++c) {  // nonsense under the mask
    std::fill_n(scene.photographs[2].begin() + c * texels, texels / 2,
                std::numeric_limits<float>::quiet_NaN());
  }
  const RefineResult nonsense = Refine(scene.Problem(), start, {}, 1);
  EXPECT_EQ(masked.maps.planes, nonsense.maps.planes);
}

TEST(Refine, KeepsTheStartWhereNothingIsSeen) {
  SyntheticScene scene = Photograph(QuarteredMaps(8, 12), 2, 8);
  for (auto& mask : scene.masks) mask[5] = 0.0f;
  const SvbrdfMaps start = DisturbedMaps(scene.truth, 1.0f, 13);
  RefineOptions alone;
  alone.pooling_passes = 0;
  const RefineResult result = Refine(scene.Problem(), start, alone, 1);
  for (int p = 0; p < kSvbrdfPlanes; ++p) EXPECT_EQ(result.maps.plane(p)[5], start.plane(p)[5]);
  // What it learns from its neighbours is its highlight alone.
  const RefineResult pooled = Refine(scene.Problem(), start, {}, 1);
  for (int p = kNormalX; p <= kDiffuseB; ++p) {
    EXPECT_EQ(pooled.maps.plane(p)[5], start.plane(p)[5]);
  }
  const StartErrors errors;
  EXPECT_NEAR(result.confidence[kSigmaRoughness * start.texels() + 5], errors.roughness, 0.01);
  EXPECT_LT(result.confidence[kSigmaDiffuseR * start.texels() + 6], 0.9 * errors.diffuse);
}

TEST(Refine, OnePhotographDoesNotMakeMapsWorse) {
  const SyntheticScene scene = Photograph(QuarteredMaps(32, 14), 1, 8);
  const SvbrdfMaps start = DisturbedMaps(scene.truth, 0.6f, 15);
  const RefineResult held = Refine(scene.Problem(), start, {}, 1);
  RefineOptions free_options;
  free_options.prior = 1e-6;
  const RefineResult loose = Refine(scene.Problem(), start, free_options, 1);
  const auto average = [&](const SvbrdfMaps& maps) {
    return (MeanSquare(maps, scene.truth, kNormalX, kNormalZ) / 4 +
            MeanSquare(maps, scene.truth, kDiffuseR, kDiffuseB) +
            MeanSquare(maps, scene.truth, kSpecularR, kSpecularB) +
            MeanSquare(maps, scene.truth, kRoughness, kRoughness)) /
           4;
  };
  EXPECT_LT(average(held.maps), 1.01 * average(start));
  EXPECT_LT(average(held.maps), average(loose.maps));
  // And yet it explains the photograph better.
  EXPECT_LT(held.summary.view_loss[0], 0.1);
}

TEST(Refine, StopsLookingAtTheStartAsViewsGrow) {
  const SvbrdfMaps truth = QuarteredMaps(16, 16);
  const SvbrdfMaps start = DisturbedMaps(truth, 1.0f, 17);
  const SyntheticScene many = Photograph(truth, 20, 8);
  RefineOptions without;
  without.prior = 0.0;
  const RefineResult held = Refine(many.Problem(), start, {}, 1);
  const RefineResult loose = Refine(many.Problem(), start, without, 1);
  for (const auto& [first, last] : {std::pair{kNormalX, kNormalZ}, {kDiffuseR, kDiffuseB}}) {
    EXPECT_LT(MeanSquare(held.maps, loose.maps, first, last),
              0.02 * MeanSquare(start, truth, first, last));
  }
}

TEST(RefineSummary, ErrorsOfTheModelAreNoReasonToHoldToTheStart) {
  RefineSummary noise;
  noise.residual_sigma = 0.01;
  noise.shared_noise = 2.25;
  EXPECT_DOUBLE_EQ(noise.holding_sigma(), noise.telling_sigma());
  RefineSummary glitter = noise, more_glitter = noise;
  glitter.residual_sigma = 0.1;
  more_glitter.residual_sigma = 0.3;
  EXPECT_LT(glitter.holding_sigma(), glitter.telling_sigma());
  EXPECT_EQ(glitter.holding_sigma(), more_glitter.holding_sigma());
}

TEST(Refine, ConfidenceGrowsWithViews) {
  const SvbrdfMaps truth = QuarteredMaps(16, 18);
  const SvbrdfMaps start = DisturbedMaps(truth, 0.5f, 19);
  double last[kTexelCost];
  std::fill(std::begin(last), std::end(last), 1e9);
  for (const int views : {1, 4, 20}) {
    const SyntheticScene scene = Photograph(truth, views, 8);
    const RefineResult result = Refine(scene.Problem(), start, {}, 1);
    for (int p = 0; p < kTexelCost; ++p) {
      const auto* plane = result.confidence.data() + p * truth.texels();
      const double mean = std::accumulate(plane, plane + truth.texels(), 0.0) / truth.texels();
      EXPECT_LT(mean, last[p]) << views << " views, plane " << p;
      EXPECT_GT(mean, 0.0);
      last[p] = mean;
    }
  }
}

// A standard deviation should be the size of errors, over many texels: within a factor of three.
TEST(Refine, ConfidenceIsOfTheSizeOfErrors) {
  const SvbrdfMaps truth = QuarteredMaps(24, 20);
  const SyntheticScene scene = Photograph(truth, 12, 8);
  const RefineResult result = Refine(scene.Problem(), DisturbedMaps(truth, 0.5f, 21), {}, 1);
  std::vector<double> ratios;
  for (size_t t = 0; t < truth.texels(); ++t) {
    const double error = std::abs(result.maps.plane(kRoughness)[t] - truth.plane(kRoughness)[t]);
    ratios.push_back(error / result.confidence[kSigmaRoughness * truth.texels() + t]);
  }
  std::nth_element(ratios.begin(), ratios.begin() + ratios.size() / 2, ratios.end());
  const double median = ratios[ratios.size() / 2];  // 0.67 for normal errors
  EXPECT_GT(median, 0.67 / 3);
  EXPECT_LT(median, 0.67 * 3);
}

TEST(Refine, TakesClippedPhotographsAsLowerBounds) {
  SyntheticScene scene = Photograph(QuarteredMaps(16, 22), 12);
  for (auto& photograph : scene.photographs) {
    for (float& value : photograph) value *= 2.5f;
  }
  for (View& view : scene.views) view.exposure = 2.5;
  scene.ldr = true;
  size_t clipped = 0, all = 0;
  for (auto& photograph : scene.photographs) {
    for (float& value : photograph) {
      clipped += value >= 1.0f;
      ++all;
      value = std::min(value, 1.0f);
    }
  }
  ASSERT_GT(clipped, all / 10);
  RefineOptions alone;
  alone.pooling_passes = 0;
  const RefineResult at_truth = Refine(scene.Problem(), scene.truth, alone, 1);
  EXPECT_LT(at_truth.summary.start_cost, 1e-8);
  // Its cost at the truth is nothing, so nothing draws the truth away from itself.
  EXPECT_LT(MeanSquare(at_truth.maps, scene.truth, kNormalX, kRoughness), 1e-8);
  const SvbrdfMaps start = DisturbedMaps(scene.truth, 0.5f, 23);
  const RefineResult result = Refine(scene.Problem(), start, {}, 1);
  EXPECT_LT(MeanSquare(result.maps, scene.truth, kNormalX, kNormalZ),
            0.02 * MeanSquare(start, scene.truth, kNormalX, kNormalZ));
}

TEST(Refine, RefusesProblemsThatDoNotFit) {
  const SyntheticScene scene = Photograph(QuarteredMaps(8, 24), 2);
  EXPECT_THROW(Refine(scene.Problem(), SvbrdfMaps(7, 8), {}, 1), std::invalid_argument);
  RefineProblem none = scene.Problem();
  none.views.clear();
  EXPECT_THROW(Refine(none, scene.truth, {}, 1), std::invalid_argument);
  SvbrdfMaps broken = scene.truth;
  broken.plane(kRoughness)[3] = std::numeric_limits<float>::quiet_NaN();
  EXPECT_THROW(Refine(scene.Problem(), broken, {}, 1), std::invalid_argument);
  RefineOptions options;
  options.robust_scale = 0.0;
  EXPECT_THROW(Refine(scene.Problem(), scene.truth, options, 1), std::invalid_argument);
}

TEST(RefinePrior, ViewsFromOnePlaceCountAsOneAndSpreadOnesMore) {
  const SyntheticScene scene = Photograph(QuarteredMaps(4, 25), 1);
  RefineProblem problem = scene.Problem();
  for (int i = 0; i < 4; ++i) problem.views.push_back(problem.views[0]);
  EXPECT_NEAR(DistinctViews(problem), 1.0, 1e-9);
  const SyntheticScene spread = Photograph(QuarteredMaps(4, 25), 5);
  const double distinct = DistinctViews(spread.Problem());
  EXPECT_GT(distinct, 2.0);
  EXPECT_LT(distinct, 5.0);
  EXPECT_LT(HoldToStart(1, 0.01, distinct, {}).strength, HoldToStart(1, 0.01, 1, {}).strength);
}

}  // namespace
}  // namespace glint
