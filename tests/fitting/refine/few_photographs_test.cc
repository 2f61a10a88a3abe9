// What few photographs leave open, and what is stated about it.
#include "fitting/refine/refine.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>
#include <utility>
#include <vector>

#include "fitting/texel/texel_prior.h"
#include "tests/fitting/refine/synthetic_scene.h"

namespace glint {
namespace {

using test::DisturbedMaps;
using test::LevelSubstance;
using test::MeanSquare;
using test::Photograph;
using test::QuarteredMaps;
using test::SyntheticScene;

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

// An estimator takes a substance's texels for alike where it cannot tell, and so does the prior:
// both err by what texels depart from the mean, and that is not known twice.
TEST(Refine, TwoPhotographsSayHowFarAnEvenInitialisationMayBeOff) {
  const SvbrdfMaps initial = LevelSubstance(32, 0.5f);
  SvbrdfMaps truth = initial;
  std::mt19937 random(29);
  std::normal_distribution<float> departure(0.0f,
                                            static_cast<float>(InitialisationErrors().roughness));
  for (float& roughness : truth.plane(kRoughness)) {
    roughness = std::clamp(roughness + departure(random), 0.05f, 1.0f);
  }
  const RefineResult result = Refine(Photograph(truth, 2, 8).Problem(), initial, {}, 1);
  double squares = 0;  // of errors, in stated deviations
  for (size_t t = 0; t < truth.texels(); ++t) {
    const double error = result.maps.plane(kRoughness)[t] - truth.plane(kRoughness)[t];
    const double deviation = result.confidence[kSigmaRoughness * truth.texels() + t];
    squares += error * error / (deviation * deviation);
  }
  const double rms = std::sqrt(squares / static_cast<double>(truth.texels()));
  EXPECT_GT(rms, 0.8);
  EXPECT_LT(rms, 1.2);
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
    options.residual_sigma = expected;
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
