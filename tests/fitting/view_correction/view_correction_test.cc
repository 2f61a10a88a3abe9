#include "fitting/view_correction/view_correction.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <random>
#include <stdexcept>

#include "tests/fitting/view_correction/disturbed_set.h"

namespace glint {
namespace {

using test::Disturb;
using test::DisturbedSet;

ViewCorrectionOptions Few() {
  ViewCorrectionOptions options;
  options.texels = 256;
  options.last_texels = 400;
  return options;
}

ViewCorrectionResult Correct(const DisturbedSet& disturbed, const ViewCorrectionOptions& options) {
  return CorrectViews(disturbed.set, disturbed.maps, options, 1);
}

// Degrees between the light found and the true one, mean over the views.
double LightErrorDeg(const DisturbedSet& disturbed, const std::vector<ViewCorrection>& found) {
  const std::vector<ViewCorrection>& errors = disturbed.errors.views;
  double sum = 0;
  for (size_t i = 0; i < found.size(); ++i) {
    View real = disturbed.set.photographs[i].view;
    ViewCorrection rest;
    for (size_t k = 0; k < 3; ++k) {
      real.light_in_sample_mm[k] += errors[i].light_offset_mm[k];
      rest.light_offset_mm[k] = found[i].light_offset_mm[k] - errors[i].light_offset_mm[k];
    }
    sum += LightTurnedDeg(real, rest) / static_cast<double>(found.size());
  }
  return sum;
}

TEST(CorrectViews, BringsLightsBackThatAreOff) {
  const DisturbedSet disturbed = Disturb(12, 0.1, 0, false);
  const ViewCorrectionResult found = Correct(disturbed, Few());
  const std::vector<ViewCorrection> none(disturbed.errors.views.size());
  EXPECT_GT(LightErrorDeg(disturbed, none), 4.5);
  EXPECT_LT(LightErrorDeg(disturbed, found.corrections.views), 1.5);
  EXPECT_LT(found.cost_after, 0.1 * found.cost_before);
}

// Maps that were fitted with lights off by one offset have absorbed it in their normals.
TEST(CorrectViews, BringsLightsBackThatAreAllOffAlikeAndHaveTiltedTheNormals) {
  DisturbedSet disturbed = Disturb(12, 0.17, 0, false, 64, true);
  SvbrdfMaps* maps = &disturbed.maps;
  for (int row = 0; row < maps->height; ++row) {
    for (int column = 0; column < maps->width; ++column) {
      const double z = maps->at(kNormalZ, row, column);
      const double x = maps->at(kNormalX, row, column) / z - 0.1 * std::cos(0.5);
      const double y = maps->at(kNormalY, row, column) / z - 0.1 * std::sin(0.5);
      const double length = std::sqrt(x * x + y * y + 1);
      maps->at(kNormalX, row, column) = static_cast<float>(x / length);
      maps->at(kNormalY, row, column) = static_cast<float>(y / length);
      maps->at(kNormalZ, row, column) = static_cast<float>(1 / length);
    }
  }
  const ViewCorrectionResult found = Correct(disturbed, Few());
  const std::vector<ViewCorrection> none(disturbed.errors.views.size());
  EXPECT_GT(LightErrorDeg(disturbed, none), 8);
  EXPECT_LT(LightErrorDeg(disturbed, found.corrections.views), 1.0);
}

TEST(CorrectViews, FindsHowPicturesAreDisplaced) {
  const DisturbedSet disturbed = Disturb(12, 0, 0.6, false);
  const ViewCorrectionResult found = Correct(disturbed, Few());
  // What the views share is the maps' own place: compare what is left without it.
  double squares = 0, count = 0;
  for (int k = 0; k < 4; ++k) {
    double common = 0;
    for (const ViewCorrection& e : disturbed.errors.views) {
      common += e.shifts.column[k] / static_cast<double>(disturbed.errors.views.size());
    }
    for (size_t i = 0; i < found.corrections.views.size(); ++i) {
      const double error = found.corrections.views[i].shifts.column[k] -
                           (disturbed.errors.views[i].shifts.column[k] - common);
      squares += error * error;
      ++count;
    }
  }
  EXPECT_LT(std::sqrt(squares / count), 0.15);  // of 0.42 before
}

TEST(CorrectViews, FindsTheAmbientLight) {
  const DisturbedSet disturbed = Disturb(12, 0, 0, true);
  ViewCorrectionOptions options = Few();
  const ViewCorrectionResult found = Correct(disturbed, options);
  for (size_t c = 0; c < 3; ++c) {
    EXPECT_NEAR(found.corrections.environment.PlaneIrradiance()[c], 3.14159 * test::kAmbientShare,
                0.035);
  }
}

// Ambient illumination and albedos that are a little darker explain nearly the same.
TEST(CorrectViews, AmbientIlluminationLeavesAlbedosUncertain) {
  const DisturbedSet disturbed = Disturb(12, 0, 0, true);
  ViewCorrectionOptions options = Few();
  options.light = options.registration = false;
  const auto found = [&](double expected) {
    options.expected.ambient = expected;
    return Correct(disturbed, options).corrections;
  };
  const ViewCorrections open = found(0.1), firm = found(0.001);
  // What is missing of it is in the albedos instead, by the flash's mean cosine of .8.
  const double missing = test::kAmbientShare - open.environment.PlaneIrradiance()[0] / 3.14159;
  EXPECT_LT(std::abs(missing) / 0.8, 3 * open.systematic_sd.diffuse);
  EXPECT_LT(open.systematic_sd.diffuse, 0.1);
  EXPECT_LT(firm.systematic_sd.diffuse, 0.1 * open.systematic_sd.diffuse);
}

// Phones are now nearer, now farther; the surroundings are not.
TEST(CorrectViews, EnvironmentLightingIsTheSameForViewsFromAnyDistance) {
  DisturbedSet disturbed = Disturb(12, 0, 0, false);
  disturbed.set.convention.falloff = LightFalloff::kInverseSquare;
  const EnvironmentLighting environment{
      {{test::kAmbientShare, test::kAmbientShare, test::kAmbientShare}}};
  for (size_t i = 0; i < disturbed.set.photographs.size(); ++i) {
    Photograph& photograph = disturbed.set.photographs[i];
    View& view = photograph.view;
    view.light_in_sample_mm[2] *= 1 + 0.05 * static_cast<double>(i);
    for (double& power : view.light_rgb) power *= 5;
    RenderView(disturbed.maps, disturbed.set.plane, view, disturbed.set.convention,
               photograph.rgb.data());
    AddEnvironmentLighting(environment, disturbed.maps, disturbed.set.plane, view,
                           disturbed.set.convention, photograph.rgb.data());
  }
  ViewCorrectionOptions options = Few();
  options.light = options.registration = false;
  const ViewCorrectionResult found = Correct(disturbed, options);
  const Vec3d irradiance = found.corrections.environment.PlaneIrradiance();
  for (size_t c = 0; c < 3; ++c) EXPECT_NEAR(irradiance[c], 3.14159 * test::kAmbientShare, 0.035);
}

// A window to the right that the sample's gloss sees too.
TEST(CorrectViews, FindsWhereEnvironmentLightingComesFrom) {
  EnvironmentLighting environment;
  environment.radiance_rgb.assign(9, {0, 0, 0});
  environment.radiance_rgb[0] = {0.05, 0.05, 0.06};
  environment.radiance_rgb[3] = {0.03, 0.02, 0.02};  // toward +x
  const DisturbedSet disturbed = test::DisturbLitBy(environment, 12, 0, 0, 64, false);
  ViewCorrectionOptions options = Few();
  options.light = options.registration = false;
  options.expected.ambient = options.expected.ambient_direction = 1;
  options.environment_terms = 9;
  const ViewCorrectionResult found = Correct(disturbed, options);
  EXPECT_LT(found.cost_after, 0.05 * found.cost_before);
  const std::vector<Vec3d>& terms = found.corrections.environment.radiance_rgb;
  for (size_t c = 0; c < 3; ++c) {
    EXPECT_NEAR(terms[3][c], environment.radiance_rgb[3][c], 0.003);
    EXPECT_NEAR(terms[1][c], 0, 0.003);  // toward +y
  }
}

TEST(CorrectViews, WhatIsMaskedMayBeAnything) {
  DisturbedSet disturbed = Disturb(12, 0.1, 0, false);
  Photograph& photograph = disturbed.set.photographs[4];
  const size_t texels = photograph.mask.size();
  for (size_t k = 0; k < texels; ++k) {
    if (k % 64 < 50) continue;
    photograph.mask[k] = 0;
    for (size_t c = 0; c < 3; ++c) {
      photograph.rgb[c * texels + k] = std::numeric_limits<float>::quiet_NaN();
    }
  }
  const ViewCorrectionResult found = Correct(disturbed, Few());
  EXPECT_LT(LightErrorDeg(disturbed, found.corrections.views), 1.5);
}

TEST(CorrectViews, FindsAnExposureThatIsOffWhereItMay) {
  DisturbedSet disturbed = Disturb(12, 0, 0, false);
  for (float& value : disturbed.set.photographs[3].rgb) value *= 1.15f;
  ViewCorrectionOptions options = Few();
  options.registration = false;
  options.environment_terms = 0;
  EXPECT_EQ(Correct(disturbed, options).corrections.views[3].exposure, 1);
  options.exposure = true;
  const ViewCorrectionResult found = Correct(disturbed, options);
  EXPECT_NEAR(found.corrections.views[3].exposure / found.corrections.views[4].exposure, 1.15,
              0.02);
  EXPECT_NEAR(found.corrections.views[5].exposure / found.corrections.views[4].exposure, 1, 0.02);
}

TEST(CorrectViews, LeavesRightViewsRight) {
  const DisturbedSet right = Disturb(8, 0, 0, false);
  ViewCorrectionOptions options = Few();
  options.last_texels = 3600;  // all: fewer are not as level as the sample
  const ViewCorrectionResult found = Correct(right, options);
  for (const ViewCorrection& c : found.corrections.views) {
    for (size_t k = 0; k < 3; ++k) EXPECT_NEAR(c.light_offset_mm[k], 0, 1e-3);
    for (int k = 0; k < 4; ++k) EXPECT_NEAR(c.shifts.column[k], 0, 1e-3);
  }
}

// Looking pictures up between texels averages their noise.
TEST(CorrectViews, LessNoiseIsNoReasonToMovePictures) {
  DisturbedSet noisy = Disturb(8, 0, 0, false);
  std::mt19937 random(3);
  for (Photograph& photograph : noisy.set.photographs) {
    for (float& x : photograph.rgb)
      x *= static_cast<float>(1 + 0.05 * (random() / 2147483648.0 - 1));
  }
  ViewCorrections between;  // where the descent would not get out of
  for (size_t i = 0; i < noisy.set.photographs.size(); ++i) {
    ViewCorrection moved;
    for (int k = 0; k < 4; ++k) {
      moved.shifts.column[k] = i % 2 == 0 ? 0.35 : -0.35;
      moved.shifts.row[k] = i % 4 < 2 ? 0.35 : -0.35;
    }
    between.views.push_back(moved);
  }
  const ViewCorrectionResult found = CorrectViews(noisy.set, noisy.maps, Few(), 1, between);
  for (const ViewCorrection& c : found.corrections.views) EXPECT_LT(c.shifts.rms(), 1e-6);
  EXPECT_LT(found.GainOver(found.cost_before), 0.02);
}

TEST(CorrectViews, LeavesAloneWhatIsNotToBeCorrected) {
  const DisturbedSet disturbed = Disturb(6, 0.1, 0.5, true);
  ViewCorrectionOptions options = Few();
  options.light = false;
  options.environment_terms = 0;
  const ViewCorrectionResult found = Correct(disturbed, options);
  bool moved = false;
  for (const ViewCorrection& c : found.corrections.views) {
    EXPECT_EQ(c.light_offset_mm, (Vec3d{0, 0, 0}));
    EXPECT_EQ(c.exposure, 1);
    moved = moved || c.shifts.any();
  }
  EXPECT_TRUE(moved);
  EXPECT_FALSE(found.corrections.environment.any());
}

TEST(CorrectViews, AViewThatShowsNothingStaysAsItIs) {
  DisturbedSet disturbed = Disturb(5, 0.1, 0, false);
  std::fill(disturbed.set.photographs[2].mask.begin(), disturbed.set.photographs[2].mask.end(),
            0.0f);
  ViewCorrectionOptions options = Few();
  options.registration = false;
  const ViewCorrectionResult found = Correct(disturbed, options);
  EXPECT_EQ(found.corrections.views[2].light_offset_mm, (Vec3d{0, 0, 0}));
  EXPECT_NE(found.corrections.views[1].light_offset_mm, (Vec3d{0, 0, 0}));
}

TEST(CorrectViews, TheSameForAnyNumberOfThreads) {
  const DisturbedSet disturbed = Disturb(6, 0.1, 0.5, true);
  ViewCorrectionOptions options = Few();
  options.iterations = 4;
  const ViewCorrectionResult one = CorrectViews(disturbed.set, disturbed.maps, options, 1);
  const ViewCorrectionResult three = CorrectViews(disturbed.set, disturbed.maps, options, 3);
  EXPECT_EQ(one.cost_after, three.cost_after);
  for (size_t i = 0; i < one.corrections.views.size(); ++i) {
    EXPECT_EQ(one.corrections.views[i].light_offset_mm, three.corrections.views[i].light_offset_mm);
  }
  EXPECT_EQ(one.corrections.environment.radiance_rgb, three.corrections.environment.radiance_rgb);
  EXPECT_EQ(one.corrections.systematic_sd, three.corrections.systematic_sd);
}

TEST(CorrectViews, RefusesMapsOfAnotherSize) {
  const DisturbedSet disturbed = Disturb(3, 0, 0, false, 32);
  EXPECT_THROW(CorrectViews(disturbed.set, SvbrdfMaps(31, 32), Few(), 1), std::invalid_argument);
  ViewCorrectionOptions wrong = Few();
  wrong.expected.light = 0;
  EXPECT_THROW(Correct(disturbed, wrong), std::invalid_argument);
  wrong = Few();
  wrong.environment_terms = 5;
  EXPECT_THROW(Correct(disturbed, wrong), std::invalid_argument);
}

TEST(Corrected, UndoesTheDisturbanceForAnyNumberOfThreads) {
  const DisturbedSet disturbed = Disturb(3, 0.1, 0.5, true);
  const PhotographSet one = Corrected(disturbed.set, disturbed.errors, 1);
  const PhotographSet two = Corrected(disturbed.set, disturbed.errors, 2);
  double left = 0, before = 0;
  std::vector<float> rendered(3 * disturbed.maps.texels());
  for (size_t i = 0; i < one.photographs.size(); ++i) {
    EXPECT_EQ(one.photographs[i].rgb, two.photographs[i].rgb);
    const View& view = one.photographs[i].view;
    RenderView(disturbed.maps, one.plane, view, one.convention, rendered.data());
    AddEnvironmentLighting(one.environment, disturbed.maps, one.plane, view, one.convention,
                           rendered.data());
    for (size_t t = 0; t < rendered.size(); ++t) {
      if (one.photographs[i].mask[t % disturbed.maps.texels()] < 0.5f) continue;
      left += std::abs(rendered[t] - one.photographs[i].rgb[t]);
      before += std::abs(rendered[t] - disturbed.set.photographs[i].rgb[t]);
    }
  }
  EXPECT_LT(left, 0.35 * before);
}

TEST(AtSize, ScalesDisplacementsWithThePicture) {
  ViewCorrection c;
  c.shifts.column[1] = 0.5;
  c.shifts.row[2] = -0.25;
  const ViewCorrections large = AtSize({{c}, {}, {}}, 100, 50, 200, 200);
  EXPECT_DOUBLE_EQ(large.views[0].shifts.column[1], 1.0);
  EXPECT_DOUBLE_EQ(large.views[0].shifts.row[2], -1.0);
}

}  // namespace
}  // namespace glint
