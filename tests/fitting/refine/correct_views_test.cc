#include "fitting/refine/correct_views.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <tuple>

#include "tests/fitting/view_correction/disturbed_set.h"

namespace glint {
namespace {

using test::Disturb;
using test::DisturbedSet;

constexpr double kTenDegrees = 0.176;  // of the light's distance

CorrectionResult Find(const DisturbedSet& disturbed) {
  CorrectionOptions options;
  options.view.texels = 256;
  options.view.last_texels = 1024;
  // One material for all: what the photographs do not tell is not known beforehand.
  const SvbrdfMaps start = test::UniformMaps(disturbed.maps.width, 0.35f, 0.06f, 0.45f);
  return FindCorrections(disturbed.set, start, RefineOptions{}, options, 1);
}

// Degrees between the lights found and the true ones, mean over the views.
double LightErrorDeg(const DisturbedSet& disturbed, const CorrectionResult& found) {
  double sum = 0;
  for (size_t i = 0; i < disturbed.errors.views.size(); ++i) {
    View real = disturbed.set.photographs[i].view;
    ViewCorrection rest;
    for (size_t k = 0; k < 3; ++k) {
      real.light_in_sample_mm[k] += disturbed.errors.views[i].light_offset_mm[k];
      rest.light_offset_mm[k] = (found.taken ? found.corrections.views[i].light_offset_mm[k] : 0) -
                                disturbed.errors.views[i].light_offset_mm[k];
    }
    sum += LightTurnedDeg(real, rest) / static_cast<double>(disturbed.errors.views.size());
  }
  return sum;
}

TEST(FindCorrections, LightsThatAreOffByTenDegreesComeBack) {
  for (const bool together : {false, true}) {
    const DisturbedSet disturbed = Disturb(20, kTenDegrees, 0, false, 32, together);
    const CorrectionResult found = Find(disturbed);
    EXPECT_GT(LightErrorDeg(disturbed, {}), 8);
    ASSERT_TRUE(found.taken);
    EXPECT_LT(LightErrorDeg(disturbed, found), 0.8) << (together ? "together" : "each");
  }
}

// Environment lighting that is not even explains a little of what lights that are off would, and
// the other way.
TEST(FindCorrections, EnvironmentLightingMovesNoFlash) {
  EnvironmentLighting environment;
  environment.radiance_rgb.assign(16, {0, 0, 0});
  for (size_t j = 0; j < 16; ++j) {
    for (size_t c = 0; c < 3; ++c) {
      environment.radiance_rgb[j][c] =
          j == 0 ? 0.06 : 0.02 * std::sin(2.7 * static_cast<double>(j));
    }
  }
  const DisturbedSet disturbed = test::DisturbLitBy(environment, 20, 0, 0, 32, false);
  const CorrectionResult found = Find(disturbed);
  ASSERT_TRUE(found.taken);
  EXPECT_LT(found.cost_after, 0.5 * found.cost_before);
  EXPECT_LT(LightErrorDeg(disturbed, found), 1e-4);
  for (size_t c = 0; c < 3; ++c) {
    EXPECT_NEAR(found.corrections.environment.PlaneIrradiance()[c],
                environment.PlaneIrradiance()[c], 0.25 * environment.PlaneIrradiance()[c]);
  }
}

// Root mean square of the errors of some planes, in stated deviations.
double ErrorsInDeviations(const RefineResult& result, const SvbrdfMaps& truth, int plane, int sigma,
                          int count) {
  double squares = 0;
  for (int c = 0; c < count; ++c) {
    for (size_t t = 0; t < truth.texels(); ++t) {
      const double error = result.maps.plane(plane + c)[t] - truth.plane(plane + c)[t];
      const double deviation =
          result.confidence[static_cast<size_t>(sigma + c) * truth.texels() + t];
      squares += error * error / (deviation * deviation);
    }
  }
  return std::sqrt(squares / (count * static_cast<double>(truth.texels())));
}

TEST(FindCorrections, DeviationsHoldWhatIsNotKnownOfTheViews) {
  const DisturbedSet disturbed = Disturb(20, kTenDegrees / 2, 0.5, true, 32);
  const CorrectionResult found = Find(disturbed);
  ASSERT_TRUE(found.taken);
  const PhotographSet corrected = Corrected(disturbed.set, found.corrections, 1);
  const SvbrdfMaps initial = test::UniformMaps(disturbed.maps.width, 0.35f, 0.06f, 0.45f);
  RefineProblem problem = ProblemOf(corrected);
  const RefineResult result = Refine(problem, initial, {}, 1);
  for (const auto& [plane, sigma, count] : {std::tuple{kDiffuseR, kSigmaDiffuseR, 3},
                                            {kSpecularR, kSigmaSpecularR, 3},
                                            {kRoughness, kSigmaRoughness, 1},
                                            {kNormalX, kSigmaNormalX, 2}}) {
    const double errors = ErrorsInDeviations(result, disturbed.maps, plane, sigma, count);
    EXPECT_GT(errors, 0.2) << plane;
    EXPECT_LT(errors, 1.5) << plane;
  }
  problem.systematic_sd = {};  // as if the corrections were certain
  EXPECT_GT(ErrorsInDeviations(Refine(problem, initial, {}, 1), disturbed.maps, kDiffuseR,
                               kSigmaDiffuseR, 3),
            3);
}

TEST(FindCorrections, LeavesViewsAloneThatAreRight) {
  const DisturbedSet right = Disturb(20, 0, 0, false, 32);
  EXPECT_FALSE(Find(right).taken);
}

}  // namespace
}  // namespace glint
