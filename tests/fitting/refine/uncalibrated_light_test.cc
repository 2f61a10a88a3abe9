// Lights, beams and exposures that nobody calibrated are found; those that are right stay.
#include "fitting/refine/refine.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "tests/fitting/refine/synthetic_scene.h"

namespace glint {
namespace {

using test::DisturbedMaps;
using test::LevelSubstance;
using test::MeanSquare;
using test::Photograph;
using test::QuarteredMaps;
using test::SyntheticScene;

// A flash that stands beside where all views say it does: highlights of a level sample tell.
TEST(Refine, FindsWhereTheFlashStands) {
  const SvbrdfMaps truth = LevelSubstance(32, 0.2f);
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

// Quarters that reflect 10 % and 30 % lie in a darker and in a brighter corner, if a sample is made
// of dielectrics and metals: here it is.
TEST(Refine, LeavesTheShapeOfALightThatIsAsSaid) {
  SvbrdfMaps truth = QuarteredMaps(40, 26);
  for (int p = kSpecularR; p <= kSpecularB; ++p) {
    for (float& f0 : truth.plane(p))
      f0 *= f0 < 0.06f ? 1.0f : f0 < 0.15f ? 0.3f : f0 < 0.4f ? 1.67f : 1;
  }
  const SyntheticScene scene = Photograph(truth, 8, 8);
  RefineOptions options;
  options.kinds.light_power_spread = 0.5;
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

// Photographs whose dark a phone crushed: albedos come out too dark and roughness too low.
TEST(Refine, FindsTheCurveOfThePhotographs) {
  SharedLight curve;
  curve.values[kSharedToe] = 0.02 / kToeUnit;
  curve.values[kSharedShoulder] = 0.2;
  const SyntheticScene scene = Photograph(QuarteredMaps(24, 26), 8, 8, 5, curve);
  const SvbrdfMaps start = DisturbedMaps(scene.truth, 0.5f, 27);
  RefineOptions options;
  options.exposure_spread = 0.1;
  const SvbrdfMaps believed = Refine(scene.Problem(), start, options, 1).maps;
  options.toe = 0.02;
  options.shoulder = 0.2;
  const RefineResult found = Refine(scene.Problem(), start, options, 1);
  const SharedLightValues& values = found.summary.shared_light.values;
  EXPECT_NEAR(kToeUnit * values[kSharedToe], 0.02, 0.006);
  EXPECT_NEAR(values[kSharedShoulder], 0.2, 0.1);
  for (const auto& [first, last] : {std::pair{kDiffuseR, kDiffuseB}, {kSpecularR, kSpecularB}}) {
    EXPECT_LT(MeanSquare(found.maps, scene.truth, first, last),
              0.5 * MeanSquare(believed, scene.truth, first, last));
  }
}

TEST(Refine, LeavesACurveThatIsStraight) {
  const SyntheticScene scene = Photograph(QuarteredMaps(24, 26), 8, 8);
  RefineOptions options;
  options.exposure_spread = 0.1;
  options.toe = 0.02;
  options.shoulder = 0.2;
  const SharedLightValues values =
      Refine(scene.Problem(), DisturbedMaps(scene.truth, 0.5f, 27), options, 1)
          .summary.shared_light.values;
  EXPECT_NEAR(kToeUnit * values[kSharedToe], 0, 0.002);
  EXPECT_NEAR(values[kSharedShoulder], 0, 0.05);
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

}  // namespace
}  // namespace glint
