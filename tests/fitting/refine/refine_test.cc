// Refinement as a solver: what it finds, leaves alone and refuses.
#include "fitting/refine/refine.h"
#include "base/model/substances.h"
#include "fitting/refine/substances.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

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

// What a capture that nobody calibrated leaves open about its views.
RefineOptions EverythingUnknown() {
  RefineOptions options;
  options.flash_offset = 0.05;
  options.exposure_spread = 0.1;
  options.light_spread = 0.02;
  return options;
}

TEST(Refine, RecoversKnownMapsFromNoiseFreePhotographs) {
  const SyntheticScene scene = Photograph(QuarteredMaps(24, 1), 16);
  const SvbrdfMaps start = DisturbedMaps(scene.truth, 1.0f, 2);
  RefineOptions photographs_alone;  // these texels have nothing in common
  photographs_alone.prior = 0;
  const RefineResult result = Refine(scene.Problem(), start, photographs_alone, 1);
  EXPECT_LT(MeanSquare(result.maps, scene.truth, kNormalX, kNormalZ), 1e-6);
  EXPECT_LT(MeanSquare(result.maps, scene.truth, kDiffuseR, kDiffuseB), 1e-6);
  // A narrow highlight that no view shows leaves specular and roughness open in a few texels. The
  // search ends where what is left is below what residuals are believed to be, most of a percent.
  EXPECT_GT(ShareWithin(result.maps, scene.truth, kSpecularG, 1e-2), 0.85);
  EXPECT_GT(ShareWithin(result.maps, scene.truth, kRoughness, 1e-2), 0.85);
  EXPECT_LT(ShareWithin(start, scene.truth, kRoughness, 1e-2), 0.2);
}

// The means' Newton step must use each texel's information under the same prior weight as the texel
// was solved with; otherwise it diverges and residuals grow. (Another weight may choose one
// roughness, too.)
TEST(Refine, PriorsOfLessWeightLeaveNoLargerResiduals) {
  SyntheticScene scene = Photograph(QuarteredMaps(20, 32), 7, 8);
  std::mt19937 random(31);
  std::normal_distribution<float> normal(0.0f, 0.25f);  // log radiance that no maps explain
  for (std::vector<float>& photograph : scene.photographs) {
    for (size_t t = 0; t < scene.truth.texels(); ++t) {
      const float factor = std::exp(normal(random));
      for (size_t c = 0; c < 3; ++c) photograph[c * scene.truth.texels() + t] *= factor;
    }
  }
  const SvbrdfMaps start = DisturbedMaps(scene.truth, 0.5f, 33);
  RefineOptions options;
  options.one_roughness = false;
  const double whole = Refine(scene.Problem(), start, options, 1).summary.residual_sigma;
  for (const double weight : {0.5, 0.1}) {
    options.prior = weight;
    EXPECT_LT(Refine(scene.Problem(), start, options, 1).summary.residual_sigma, whole) << weight;
  }
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

// Nearly all light of embossed black plastic is its highlight, which a level start misses.
TEST(Refine, FindsNormalsOfABlackSampleFromALevelStart) {
  SvbrdfMaps truth = QuarteredMaps(24, 31), start = truth;
  const auto fill = [](SvbrdfMaps* maps, int first, int last, float value) {
    for (int p = first; p <= last; ++p) std::ranges::fill(maps->plane(p), value);
  };
  fill(&truth, kDiffuseR, kDiffuseB, 0.004f);
  fill(&truth, kSpecularR, kSpecularB, 0.04f);
  fill(&truth, kRoughness, kRoughness, 0.27f);
  fill(&start, kDiffuseR, kDiffuseB, 0.004f);
  fill(&start, kSpecularR, kSpecularB, 0.13f);
  fill(&start, kRoughness, kRoughness, 0.14f);
  fill(&start, kNormalX, kNormalY, 0.0f);
  fill(&start, kNormalZ, kNormalZ, 1.0f);
  const SyntheticScene scene = Photograph(truth, 20, 8);
  const RefineResult result = Refine(scene.Problem(), start, {}, 1);
  EXPECT_GT(MeanSquare(start, truth, kNormalX, kNormalY), 0.02);
  EXPECT_LT(MeanSquare(result.maps, truth, kNormalX, kNormalY), 5e-4);  // 4.5e-3 without the start
  EXPECT_LT(MeanSquare(result.maps, truth, kRoughness, kRoughness), 5e-4);  // 5.1e-3
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
  const RefineOptions options = EverythingUnknown();
  const RefineResult one = Refine(scene.Problem(), start, options, 1);
  for (const int threads : {2, 3, 8}) {
    const RefineResult several = Refine(scene.Problem(), start, options, threads);
    EXPECT_EQ(several.maps.planes, one.maps.planes);
    EXPECT_EQ(several.confidence, one.confidence);
    EXPECT_EQ(several.summary.final_cost, one.summary.final_cost);
    EXPECT_EQ(several.summary.view_loss, one.summary.view_loss);
    EXPECT_EQ(several.summary.exposures, one.summary.exposures);
  }
}

TEST(Refine, DoesNotDependOnTheOrderOfPhotographs) {
  const SyntheticScene scene = Photograph(QuarteredMaps(16, 8), 7, 8);
  const SvbrdfMaps start = DisturbedMaps(scene.truth, 1.0f, 9);
  RefineProblem problem = scene.Problem();
  const RefineOptions options = EverythingUnknown();
  const RefineResult forward = Refine(problem, start, options, 1);
  std::reverse(problem.views.begin(), problem.views.end());
  const RefineResult backward = Refine(problem, start, options, 1);
  EXPECT_EQ(forward.maps.planes, backward.maps.planes);
  std::vector<double> losses = backward.summary.view_loss;
  std::reverse(losses.begin(), losses.end());
  EXPECT_EQ(forward.summary.view_loss, losses);
  std::vector<double> exposures = backward.summary.exposures;
  std::reverse(exposures.begin(), exposures.end());
  EXPECT_EQ(forward.summary.exposures, exposures);
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
  const RefineResult result = Refine(scene.Problem(), start, {}, 1);
  for (int p = 0; p < kSvbrdfPlanes; ++p) EXPECT_EQ(result.maps.plane(p)[5], start.plane(p)[5]);
  // What is known of it is what is known beforehand: more than nothing, less than of one that is
  // seen.
  const auto sigma = [&](int plane, size_t texel) {
    return result.confidence[plane * start.texels() + texel];
  };
  EXPECT_GT(sigma(kSigmaDiffuseR, 5), 3 * sigma(kSigmaDiffuseR, 6));
  // No wider than the model's own prior: as texels of a substance differ, and substances from each
  // other.
  EXPECT_LT(sigma(kSigmaRoughness, 5),
            constants::kRoughnessSd * std::hypot(1.0, constants::kBetweenToWithin));
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
  RefineOptions without_prior;
  without_prior.prior = 0;
  const RefineResult at_truth = Refine(scene.Problem(), scene.truth, without_prior, 1);
  EXPECT_LT(at_truth.summary.start_cost, 1e-8);
  // Its cost at the truth is nothing, so nothing draws the truth away from itself.
  EXPECT_LT(MeanSquare(at_truth.maps, scene.truth, kNormalX, kRoughness), 1e-8);
  const SvbrdfMaps start = DisturbedMaps(scene.truth, 0.5f, 23);
  const RefineResult result = Refine(scene.Problem(), start, without_prior, 1);
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

}  // namespace
}  // namespace glint
