#include "fitting/refine/refine.h"
#include "fitting/refine/substances.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <random>

#include "fitting/texel/texel_prior.h"
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
            kExpectedRoughnessSpread * std::hypot(1.0, kBetweenToWithin));
}

TEST(Refine, OnePhotographDoesNotMakeMapsWorse) {
  const SyntheticScene scene = Photograph(QuarteredMaps(32, 14), 1, 8);
  const SvbrdfMaps start = DisturbedMaps(scene.truth, 1.2f, 15);  // errors of .12
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

// Two photographs hardly tell relief that scatters a flash from a rough surface's own scatter.
// An estimator flattens what it cannot see: that its normals are level does not say that the
// surface is.
TEST(Refine, OnePhotographSaysHowFarALevelStartMayBeOff) {
  const SvbrdfMaps truth = QuarteredMaps(32, 23);
  SvbrdfMaps start = DisturbedMaps(truth, 0.5f, 24);
  for (const int plane : {kNormalX, kNormalY}) std::ranges::fill(start.plane(plane), 0.0f);
  std::ranges::fill(start.plane(kNormalZ), 1.0f);
  const RefineResult result = Refine(Photograph(truth, 1, 8).Problem(), start, {}, 1);
  double squares = 0;  // of errors, in stated deviations
  for (size_t t = 0; t < truth.texels(); ++t) {
    for (const auto& [plane, sigma] :
         {std::pair{kNormalX, kSigmaNormalX}, {kNormalY, kSigmaNormalY}}) {
      const double error = result.maps.plane(plane)[t] - truth.plane(plane)[t];
      const double deviation = result.confidence[sigma * truth.texels() + t];
      squares += error * error / (deviation * deviation);
    }
  }
  const double rms = std::sqrt(squares / (2.0 * static_cast<double>(truth.texels())));
  // This surface scatters by more than an estimator's errors are said to.
  const double more =
      std::sqrt(MeanSquare(start, truth, kNormalX, kNormalY)) / InitialisationErrors().normal;
  EXPECT_GT(rms, 0.5);
  EXPECT_LT(rms, 1.2 * more);
}

TEST(Refine, TwoPhotographsKeepWhatTheStartKnowsOfRoughness) {
  SvbrdfMaps truth = QuarteredMaps(32, 21);
  for (size_t t = 0; t < truth.texels(); ++t) {
    float* normal[3] = {&truth.plane(kNormalX)[t], &truth.plane(kNormalY)[t],
                        &truth.plane(kNormalZ)[t]};
    *normal[0] *= 2;
    *normal[1] *= 2;
    *normal[2] = std::sqrt(1 - *normal[0] * *normal[0] - *normal[1] * *normal[1]);
    truth.plane(kRoughness)[t] = 0.57f;
    for (int c = 0; c < 3; ++c) {
      truth.plane(kDiffuseR + c)[t] *= 0.4f / truth.plane(kDiffuseR)[t];
      truth.plane(kSpecularR + c)[t] = 0.04f;
    }
  }
  const SyntheticScene scene = Photograph(truth, 2, 8);
  const SvbrdfMaps start = DisturbedMaps(truth, 1.0f, 22);
  const RefineResult result = Refine(scene.Problem(), start, {}, 1);
  EXPECT_LT(MeanSquare(result.maps, truth, kRoughness, kRoughness),
            0.7 * MeanSquare(start, truth, kRoughness, kRoughness));
}

TEST(Refine, ExpectedResidualsMatterWherePhotographsAreFew) {
  const SvbrdfMaps truth = QuarteredMaps(16, 25);
  const SvbrdfMaps start = DisturbedMaps(truth, 0.5f, 26);
  const auto residuals = [&](int views, double expected) {
    RefineOptions options;
    options.residual_deviation = expected;
    return Refine(Photograph(truth, views, 8).Problem(), start, options, 1).summary.residual_sigma;
  };
  EXPECT_GT(residuals(2, 0.1), 1.3 * residuals(2, 0.05));
  EXPECT_LT(residuals(20, 0.1), 1.3 * residuals(20, 0.05));
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

TEST(Refine, ConfidenceGrowsWithViews) {
  const SvbrdfMaps truth = QuarteredMaps(16, 18);
  const SvbrdfMaps start = DisturbedMaps(truth, 0.5f, 19);
  double last[kTexelCost];
  std::fill(std::begin(last), std::end(last), 1e9);
  for (const int views : {4, 10, 20}) {
    const SyntheticScene scene = Photograph(truth, views, 8);
    const RefineResult result = Refine(scene.Problem(), start, {}, 1);
    // Of roughness and specular albedo photographs also say how far texels share them.
    for (int p = kSigmaNormalX; p <= kSigmaDiffuseB; ++p) {
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

// One substance under a smooth disturbance of its initial maps: where no photograph shows its
// highlight it is what it is elsewhere.
TEST(Refine, OneSubstanceBecomesNearlyHomogeneous) {
  SvbrdfMaps truth(32, 32);
  for (size_t t = 0; t < truth.texels(); ++t) {
    truth.plane(kNormalZ)[t] = 1;
    truth.plane(kRoughness)[t] = 0.3f;
    for (int c = 0; c < 3; ++c) {
      truth.plane(kDiffuseR + c)[t] = 0.15f + 0.05f * static_cast<float>(t % 7) / 7;
      truth.plane(kSpecularR + c)[t] = 0.05f;
    }
  }
  const SyntheticScene scene = Photograph(truth, 5, 8);
  SvbrdfMaps start = truth;
  for (size_t t = 0; t < truth.texels(); ++t) {
    const auto wave = static_cast<float>(std::sin(0.2 * static_cast<double>(t % 32)));
    start.plane(kRoughness)[t] += 0.12f * wave;
    for (int c = 0; c < 3; ++c) start.plane(kSpecularR + c)[t] *= 1 + 0.6f * wave;
  }
  const RefineResult result = Refine(scene.Problem(), start, {}, 1);
  EXPECT_LT(MeanSquare(result.maps, truth, kRoughness, kRoughness),
            0.02 * MeanSquare(start, truth, kRoughness, kRoughness));
  EXPECT_LT(MeanSquare(result.maps, truth, kSpecularR, kSpecularB),
            0.05 * MeanSquare(start, truth, kSpecularR, kSpecularB));
}

// One level substance; roughness and specular albedo of texel t: .3 + roughness(t), .05 · (1 +
// specular(t)).
template <class Roughness, class Specular>
RefineSummary SummaryOf(const Roughness& roughness, const Specular& specular) {
  SvbrdfMaps truth(32, 32);
  for (size_t t = 0; t < truth.texels(); ++t) {
    truth.plane(kNormalZ)[t] = 1;
    truth.plane(kRoughness)[t] = 0.3f + static_cast<float>(roughness(t));
    for (int c = 0; c < 3; ++c) {
      truth.plane(kDiffuseR + c)[t] = 0.1f;
      truth.plane(kSpecularR + c)[t] = 0.05f * (1 + static_cast<float>(specular(t)));
    }
  }
  SvbrdfMaps start = truth;
  for (size_t t = 0; t < truth.texels(); ++t) {
    start.plane(kRoughness)[t] = 0.35f;
    for (int c = 0; c < 3; ++c) start.plane(kSpecularR + c)[t] = 0.06f;
  }
  return Refine(Photograph(truth, 10, 8).Problem(), start, {}, 1).summary;
}

double Wave(size_t texel) {
  const size_t row = texel / 32, column = texel % 32;
  return std::sin(0.4 * static_cast<double>(row + column));
}
double Scatter(size_t texel) { return Wave(texel * 7919 % 1024); }  // the same values elsewhere
double Nothing(size_t) { return 0; }

// What neighbours tell of a texel is estimated, not assumed.
TEST(Refine, NeighboursAgreeAsFarAsTheSamplesDo) {
  const auto smooth = [](size_t t) { return 0.1 * Wave(t); };
  const auto rough = [](size_t t) { return 0.1 * Scatter(t); };
  EXPECT_LT(SummaryOf(smooth, Nothing).neighbour_spread,
            0.6 * SummaryOf(rough, Nothing).neighbour_spread);
}

// Roughness may vary within a substance where specular albedo does not, and is then no reason to
// expect that it does.
TEST(Refine, SpecularAlbedoVariesByItsOwnMeasure) {
  const auto roughness = [](size_t t) { return 0.1 * Scatter(t); };
  const RefineSummary constant = SummaryOf(roughness, Nothing);
  const RefineSummary varying =
      SummaryOf(roughness, [](size_t t) { return 0.6 * Scatter(t + 500); });
  EXPECT_LT(constant.specular_spread / constant.roughness_spread,
            0.6 * varying.specular_spread / varying.roughness_spread);
}

// Few colours, so that substances have one diffuse albedo each, or colours of all kinds.
TEST(Refine, DiffuseAlbedoIsSharedAsFarAsSubstancesHaveOne) {
  const auto spread_of = [](const auto& value) {
    SvbrdfMaps truth = QuarteredMaps(32, 41);
    for (size_t t = 0; t < truth.texels(); ++t) {
      for (size_t c = 0; c < 3; ++c) {
        truth.plane(kDiffuseR + static_cast<int>(c))[t] =
            0.3f + 0.25f * value(Scatter(t + 300 * c));
      }
    }
    const RefineSummary s =
        Refine(Photograph(truth, 4, 8).Problem(), DisturbedMaps(truth, 0.5f, 33), {}, 1).summary;
    return s.diffuse_spread;
  };
  const auto either = [](double wave) { return wave > 0 ? 1.0f : -1.0f; };
  const auto any = [](double wave) { return static_cast<float>(wave); };
  EXPECT_LT(spread_of(either), 0.7 * spread_of(any));
}

// A flash that stands beside where all views say it does: highlights of a level sample tell.
TEST(Refine, FindsWhereTheFlashStands) {
  SvbrdfMaps truth(32, 32);
  for (size_t t = 0; t < truth.texels(); ++t) {
    truth.plane(kNormalZ)[t] = 1;
    truth.plane(kRoughness)[t] = 0.2f;
    for (int c = 0; c < 3; ++c) {
      truth.plane(kDiffuseR + c)[t] = 0.15f + 0.05f * static_cast<float>(t % 7) / 7;
      truth.plane(kSpecularR + c)[t] = 0.05f;
    }
  }
  const SharedLightValues offset{0.05, -0.025};
  SyntheticScene scene = Photograph(truth, 10, 8, 5, {.values = offset, .distance_mm = 2.4});
  RefineOptions options;
  options.flash_offset = 0.05;
  const RefineResult found = Refine(scene.Problem(), truth, options, 1);
  for (size_t i = 0; i < 2; ++i) {
    // Expected beforehand at 0.11, so that it is drawn toward 0.
    EXPECT_NEAR(found.summary.shared_light.values[i], offset[i], 0.5 * std::abs(offset[i])) << i;
  }
  options.flash_offset = 0;
  const RefineResult believed = Refine(scene.Problem(), truth, options, 1);
  EXPECT_EQ(believed.summary.shared_light.values, SharedLightValues{});
  EXPECT_LT(MeanSquare(found.maps, truth, kNormalX, kNormalY),
            0.3 * MeanSquare(believed.maps, truth, kNormalX, kNormalY));
}

TEST(Refine, LeavesAFlashWhereItStands) {
  const SyntheticScene scene = Photograph(QuarteredMaps(24, 26), 8, 8);
  RefineOptions options;
  options.flash_offset = 0.05;
  const SharedLightValues found =
      Refine(scene.Problem(), DisturbedMaps(scene.truth, 0.5f, 27), options, 1)
          .summary.shared_light.values;
  // Within twice the error of the mean of normals that scatter by 0.17: 2 · 2 · 0.17 / 24.
  EXPECT_NEAR(found[kOffsetX], 0, 0.028);
  EXPECT_NEAR(found[kOffsetY], 0, 0.028);
}

// A flash whose beam passes beside the sample, and an exposure that makes up for distance: alike in
// all photographs, so that those which were not fitted are predicted too.
TEST(Refine, FindsTheShapeOfTheFlashsLight) {
  const SharedLight light{.values = {0, 0, 0.4, -0.2, 1.0}, .distance_mm = 2.4};
  const SyntheticScene scene = Photograph(QuarteredMaps(24, 26), 8, 8, 5, light);
  const SvbrdfMaps start = DisturbedMaps(scene.truth, 0.5f, 27);
  RefineOptions options;
  options.exposure_spread = 0.1;
  const double believed = MeanSquare(Refine(scene.Problem(), start, options, 1).maps, scene.truth,
                                     kDiffuseR, kDiffuseB);
  options.flash_beam = 0.3;
  options.distance_power = 1;
  const RefineResult found = Refine(scene.Problem(), start, options, 1);
  const SharedLightValues& values = found.summary.shared_light.values;
  // Exposures are expected to scatter by 0.045 at least (0.1, worth two of ten views), tangents do
  // by 0.37 and logarithms of distances by 0.08: standard deviations of 0.05 and 0.2, thrice.
  for (size_t i = kBeamX; i <= kBeamY; ++i) EXPECT_NEAR(values[i], light.values[i], 0.15) << i;
  EXPECT_NEAR(values[kDistancePower], 1.0, 0.6);
  EXPECT_LT(MeanSquare(found.maps, scene.truth, kDiffuseR, kDiffuseB), 0.7 * believed);
}

TEST(Refine, LeavesTheShapeOfALightThatIsAsSaid) {
  const SyntheticScene scene = Photograph(QuarteredMaps(24, 26), 8, 8);
  RefineOptions options;
  options.exposure_spread = 0.1;
  options.flash_beam = 0.3;
  options.distance_power = 1;
  const SharedLightValues values =
      Refine(scene.Problem(), DisturbedMaps(scene.truth, 0.5f, 27), options, 1)
          .summary.shared_light.values;
  EXPECT_NEAR(values[kBeamX], 0, 0.03);
  EXPECT_NEAR(values[kBeamY], 0, 0.03);
  EXPECT_NEAR(values[kDistancePower], 0, 0.1);
}

double RootMeanSquareLog(const std::vector<double>& factors) {
  double squares = 0;
  for (const double factor : factors) squares += std::log(factor) * std::log(factor);
  return std::sqrt(squares / static_cast<double>(factors.size()));
}

TEST(Refine, FindsTheExposuresOfSinglePhotographs) {
  SyntheticScene scene = Photograph(QuarteredMaps(24, 26), 8);
  const std::vector<double> truth = {1.2, 0.9, 1.05, 0.8, 1.1, 0.95, 1.0, 1.05};
  double mean_log = 0;
  for (const double t : truth) mean_log += std::log(t) / 8;
  for (size_t v = 0; v < truth.size(); ++v) {
    for (float& radiance : scene.photographs[v]) {
      radiance *= static_cast<float>(truth[v] / std::exp(mean_log));
    }
  }
  const SvbrdfMaps start = DisturbedMaps(scene.truth, 0.5f, 27);
  RefineOptions options;
  const double believed = MeanSquare(Refine(scene.Problem(), start, options, 1).maps, scene.truth,
                                     kSpecularR, kRoughness);
  options.exposure_spread = 0.1;
  const RefineResult found = Refine(scene.Problem(), start, options, 1);
  std::vector<double> left;
  for (size_t v = 0; v < truth.size(); ++v) {
    left.push_back(found.summary.exposures[v] * std::exp(mean_log) / truth[v]);
  }
  EXPECT_LT(RootMeanSquareLog(left), 0.02);
  EXPECT_NEAR(found.summary.exposure_spread, 0.12, 0.04);
  EXPECT_LT(MeanSquare(found.maps, scene.truth, kSpecularR, kRoughness), 0.3 * believed);
}

TEST(Refine, LeavesExposuresAndLightsThatAreRight) {
  const SyntheticScene scene = Photograph(QuarteredMaps(24, 26), 8);
  RefineOptions options;
  options.exposure_spread = 0.1;
  options.light_spread = 0.02;
  const RefineSummary found =
      Refine(scene.Problem(), DisturbedMaps(scene.truth, 0.5f, 27), options, 1).summary;
  EXPECT_LT(RootMeanSquareLog(found.exposures), 0.005);
  for (const Vec3d& offset : found.light_offsets_mm) {
    // Of a distance of 2.1 to 2.7.
    EXPECT_LT(std::hypot(offset[0], offset[1], offset[2]), 0.01);
  }
}

TEST(Refine, FindsTheLightsOfSinglePhotographs) {
  SyntheticScene scene = Photograph(QuarteredMaps(24, 26), 8);
  const SvbrdfMaps start = DisturbedMaps(scene.truth, 0.5f, 27);
  std::vector<Vec3d> wrong;
  for (size_t v = 0; v < scene.views.size(); ++v) {
    const double angle = 2 * M_PI * static_cast<double>(v) / 8;  // no offset is shared
    wrong.push_back({0.06 * std::cos(angle), 0.06 * std::sin(angle), 0});
    for (size_t i = 0; i < 3; ++i) scene.views[v].light_in_sample_mm[i] += wrong[v][i];
  }
  RefineOptions options;
  options.exposure_spread = 0.1;
  options.light_spread = 0.02;
  const RefineSummary found = Refine(scene.Problem(), start, options, 1).summary;
  double left = 0, before = 0;
  for (size_t v = 0; v < wrong.size(); ++v) {
    for (size_t i = 0; i < 2; ++i) {
      before += wrong[v][i] * wrong[v][i];
      left += std::pow(wrong[v][i] + found.light_offsets_mm[v][i], 2);
    }
  }
  EXPECT_LT(left, 0.3 * before);  // squares: about half of what they are off
}

TEST(Refine, OnePhotographsExposureIsWhatIsSaid) {
  const SyntheticScene scene = Photograph(QuarteredMaps(24, 26), 1);
  RefineOptions options;
  options.exposure_spread = 0.1;
  options.light_spread = 0.02;
  const RefineSummary found = Refine(scene.Problem(), scene.truth, options, 1).summary;
  EXPECT_EQ(found.exposures, std::vector<double>{1.0});
}

// What photographs do not support is not there: exposures that differ from photograph to photograph
// raise the discrepancy that is found.
TEST(Refine, FindsTheModelsDiscrepancy) {
  SyntheticScene scene = Photograph(QuarteredMaps(24, 26), 12);
  const SvbrdfMaps start = DisturbedMaps(scene.truth, 0.5f, 27);
  const double clean = Refine(scene.Problem(), start, {}, 1).summary.discrepancy;
  std::mt19937 random(28);
  std::normal_distribution<float> normal(0.0f, 0.1f);
  for (auto& photograph : scene.photographs) {
    const size_t texels = scene.truth.texels();
    for (size_t t = 0; t < texels; ++t) {  // common to the channels, each texel's own
      const float factor = std::exp(normal(random));
      for (size_t c = 0; c < 3; ++c) photograph[c * texels + t] *= factor;
    }
  }
  const double disturbed = Refine(scene.Problem(), start, {}, 1).summary.discrepancy;
  EXPECT_LT(clean, 0.03);
  EXPECT_GT(disturbed, 0.06);
  EXPECT_LT(disturbed, 0.15);
}

}  // namespace
}  // namespace glint
