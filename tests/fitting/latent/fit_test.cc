#include "fitting/latent/fit.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "fitting/initial_maps/rules.h"
#include "fitting/latent/descent.h"
#include "fitting/latent/fit_loss.h"
#include "fitting/latent/levels.h"
#include "tests/fitting/initial_maps/synthetic_set.h"
#include "tests/training/toy_materials.h"

namespace glint {
namespace {

using test::PhotographMaps;
using test::UniformMaps;

FitOptions Short(FitOptions options, int iterations) {
  options.coarse_iterations = iterations;
  options.fine_iterations = iterations;
  options.start_iterations = 5;
  options.fast = false;
  return options;
}

const Autoencoder& SmallNetwork() {
  static const Autoencoder network = Autoencoder::Random({16, 16, 24, 24, 24}, 1);
  return network;
}

double Difference(const SvbrdfMaps& a, const SvbrdfMaps& b) {
  double most = 0;
  for (size_t i = 0; i < a.planes.size(); ++i) {
    most = std::max(most, std::abs(double{a.planes[i]} - b.planes[i]));
  }
  return most;
}

TEST(FitLoss, GradientAgreesWithFiniteDifferences) {
  PhotographSet set = PhotographMaps(ToyMaterial(5, 9, 7), 3);
  set.photographs[2].ldr = false;  // LDR and HDR together
  set.photographs[1].mask[10] = 0;
  set.photographs[0].mask[11] = 0.5f;
  const FitLoss loss(set, 1);
  EncodedMaps maps = EncodeMaps(ToyMaterial(6, 9, 7));
  const FitLossValue value = loss.Evaluate(maps, 1.3, true);
  for (size_t i = 3; i < maps.planes.size(); i += 37) {
    const float at = maps.planes[i], step = 2e-3f;
    maps.planes[i] = at + step;
    const double up = loss.Evaluate(maps, 1.3, false).loss;
    maps.planes[i] = at - step;
    const double down = loss.Evaluate(maps, 1.3, false).loss;
    maps.planes[i] = at;
    const double slope = (up - down) / (2.0 * step);
    EXPECT_NEAR(value.gradient.planes[i], slope, 0.05 * std::abs(slope) + 2e-4) << i;
  }
  const double h = 1e-3;
  const double up = loss.Evaluate(maps, 1.3 * std::exp(h), false).loss;
  const double down = loss.Evaluate(maps, 1.3 * std::exp(-h), false).loss;
  EXPECT_NEAR(value.log_light_scale_gradient, (up - down) / (2 * h), 5e-3);
}

TEST(FitClassic, ReproducesThePhotographs) {
  const SvbrdfMaps truth = ToyMaterial(4, 40, 40);
  const PhotographSet set = PhotographMaps(truth, 4);
  const SvbrdfMaps start = EstimateMaps(set, 1);
  const FitResult result = FitClassic(set, start, Short(FitOptions::Classic(), 300));
  EXPECT_LT(result.final_loss, 0.1 * result.start_loss);
  ASSERT_EQ(result.view_loss.size(), 4u);
  for (const double loss : result.view_loss) EXPECT_LT(loss, 0.05);
}

TEST(FitLatent, LowersTheLossEvenWithoutTraining) {
  const PhotographSet set = PhotographMaps(UniformMaps(48, 0.5f, 0.1f, 0.3f), 3);
  FitOptions options = Short({}, 150);
  options.learning_rate = 0.1;
  const FitResult result =
      FitLatent(set, UniformMaps(48, 0.1f, 0.04f, 0.6f), SmallNetwork(), options);
  ASSERT_EQ(result.levels.size(), 1u);
  const std::vector<double>& curve = result.levels[0].loss;
  EXPECT_LT(*std::min_element(curve.begin(), curve.end()), 0.7 * curve.front());
  EXPECT_NEAR(result.final_loss, *std::min_element(curve.begin(), curve.end()), 1e-3);
  EXPECT_EQ(result.code.channels, 24);
}

TEST(FitLatent, MapsAreOfThePhotographsSizeWhereverTheLevelsEnd) {
  const PhotographSet set = PhotographMaps(ToyMaterial(3, 60, 44), 3);
  FitOptions options = Short({}, 5);
  options.coarse_size = 20;
  options.finest_size = 40;
  const FitResult result =
      FitLatent(set, UniformMaps(8, 0.3f, 0.1f, 0.5f), SmallNetwork(), options);
  ASSERT_EQ(result.levels.size(), 2u);
  EXPECT_EQ(result.levels[1].width, 30);
  EXPECT_EQ(result.maps.width, 60);
  EXPECT_EQ(result.maps.height, 44);
  options.finest_size = 10;
  EXPECT_NE(options.Check(), "");
}

TEST(KeepStart, ChangesNoTexelOfAStartOfAnySize) {
  // Larger than the first level of a fit, which would take detail away.
  const SvbrdfMaps start = ToyMaterial(9, 300, 280);
  const PhotographSet set = PhotographMaps(ToyMaterial(3, 300, 280), 1);
  const FitResult kept = KeepStart(set, start, 2);
  EXPECT_EQ(kept.maps.planes, start.planes);
  EXPECT_EQ(kept.start_loss, kept.final_loss);
  EXPECT_NEAR(kept.final_loss, FitLoss(set, 1).Evaluate(EncodeMaps(start), 1, false).loss, 1e-12);
  EXPECT_EQ(KeepStart(set, ToyMaterial(9, 30, 28), 1).maps.width, 300);
}

TEST(FitLatent, TuningTheDecoderLowersTheLossBelowTheCodesOwn) {
  const PhotographSet set = PhotographMaps(ToyMaterial(3, 48, 40), 3);
  const SvbrdfMaps start = EstimateMaps(set, 1);
  FitOptions options = Short({}, 30);
  const FitResult plain = FitLatent(set, start, SmallNetwork(), options);
  options.tune_iterations = 40;
  const FitResult tuned = FitLatent(set, start, SmallNetwork(), options);
  EXPECT_LT(tuned.final_loss, 0.8 * plain.final_loss);
  ASSERT_EQ(tuned.levels.size(), 2u);
  EXPECT_FALSE(tuned.levels[0].tuned);
  EXPECT_TRUE(tuned.levels[1].tuned);
  EXPECT_EQ(tuned.levels[0].loss, plain.levels[0].loss);
}

TEST(FitLatent, TheTunedDecodersBitsDoNotDependOnThreads) {
  const PhotographSet set = PhotographMaps(ToyMaterial(3, 64, 40), 2);
  const SvbrdfMaps start = EstimateMaps(set, 1);
  FitOptions options = Short({}, 5);
  options.tune_iterations = 5;
  const FitResult one = FitLatent(set, start, SmallNetwork(), options);
  options.threads = 2;
  EXPECT_EQ(one.maps.planes, FitLatent(set, start, SmallNetwork(), options).maps.planes);
}

TEST(FitLatent, BitsDoNotDependOnThreads) {
  const PhotographSet set = PhotographMaps(ToyMaterial(7, 96, 70), 2);
  const SvbrdfMaps start = EstimateMaps(set, 1);
  for (const bool fast : {false, true}) {
    FitOptions options = Short({}, 6);
    options.coarse_size = 48;  // two levels
    options.fast = fast;
    const FitResult one = FitLatent(set, start, SmallNetwork(), options);
    options.threads = 2;
    const FitResult two = FitLatent(set, start, SmallNetwork(), options);
    ASSERT_EQ(one.levels.size(), 2u);
    EXPECT_EQ(one.maps.planes, two.maps.planes) << fast;
    EXPECT_EQ(one.levels[1].loss, two.levels[1].loss) << fast;
  }
}

TEST(FitClassic, BitsDoNotDependOnThreads) {
  const PhotographSet set = PhotographMaps(ToyMaterial(7, 96, 70), 2);
  const SvbrdfMaps start = EstimateMaps(set, 1);
  FitOptions options = Short(FitOptions::Classic(), 15);
  const FitResult one = FitClassic(set, start, options);
  options.threads = 2;
  EXPECT_EQ(one.maps.planes, FitClassic(set, start, options).maps.planes);
}

TEST(Fit, TheOrderOfPhotographsDoesNotMatter) {
  PhotographSet set = PhotographMaps(ToyMaterial(8, 32, 32), 4);
  const SvbrdfMaps start = EstimateMaps(set, 1);
  const FitOptions options = Short(FitOptions::Classic(), 20);
  const FitResult forward = FitClassic(set, start, options);
  std::reverse(set.photographs.begin(), set.photographs.end());
  const FitResult backward = FitClassic(set, start, options);
  EXPECT_NEAR(forward.final_loss, backward.final_loss, 1e-3 * forward.final_loss);
  EXPECT_LT(Difference(forward.maps, backward.maps), 0.05);
}

TEST(Fit, MaskedTexelsHaveNoSay) {
  PhotographSet set = PhotographMaps(ToyMaterial(8, 32, 32), 2);
  for (Photograph& photo : set.photographs) {
    for (int i = 0; i < 300; ++i) photo.mask[i] = 0;
  }
  const SvbrdfMaps start = EstimateMaps(set, 1);
  const FitOptions options = Short(FitOptions::Classic(), 10);
  const FitResult clean = FitClassic(set, start, options);
  for (Photograph& photo : set.photographs) {
    for (int i = 0; i < 300; ++i) photo.rgb[i] = 77;
  }
  EXPECT_EQ(clean.maps.planes, FitClassic(set, start, options).maps.planes);
}

TEST(Fit, ClippedPhotographsAskForNoMoreThanClippedRenderings) {
  // A mirror-like sample clips under the flash; as LDR its true maps cost nothing.
  const SvbrdfMaps truth = UniformMaps(32, 0.2f, 0.5f, 0.2f);
  PhotographSet set = PhotographMaps(truth, 1);
  EXPECT_LT(FitLoss(set, 1).Evaluate(EncodeMaps(truth), 1, false).loss, 1e-4);
  set.photographs[0].ldr = false;
  EXPECT_GT(FitLoss(set, 1).Evaluate(EncodeMaps(truth), 1, false).loss, 1e-2);
}

TEST(Fit, AnUnknownLightPowerIsFoundWithTheMaps) {
  const SvbrdfMaps truth = UniformMaps(32, 0.3f, 0.05f, 0.4f);
  PhotographSet set = PhotographMaps(truth, 4, true, 1.5);
  for (Photograph& photo : set.photographs) {
    for (double& power : photo.view.light_rgb) power /= 1.5;
  }
  FitOptions options = Short(FitOptions::Classic(), 80);
  options.learning_rate = 1e-4;  // the maps are right: the power alone is wrong
  const FitResult known = FitClassic(set, truth, options);
  EXPECT_EQ(known.light_scale, 1.0);
  set.light_power_known = false;
  const FitResult found = FitClassic(set, truth, options);
  EXPECT_NEAR(found.light_scale, 1.5, 0.1);
  EXPECT_LT(found.final_loss, 0.2 * known.final_loss);
}

TEST(Fit, WrongInputIsRefused) {
  const PhotographSet set = PhotographMaps(ToyMaterial(8, 32, 32), 1);
  const SvbrdfMaps start = EstimateMaps(set, 1);
  PhotographSet empty = set;
  empty.photographs.clear();
  EXPECT_THROW(FitClassic(empty, start, FitOptions::Classic()), std::invalid_argument);
  FitOptions rate = FitOptions::Classic();
  rate.learning_rate = 0;
  EXPECT_THROW(FitClassic(set, start, rate), std::invalid_argument);
}

TEST(Descent, StopsWhenTheLossNoLongerFallsAndKeepsTheBest) {
  Descent descent({10'000, 0.1, 1e-3, 20}, 2);
  std::vector<float> x{3.0f, -2.0f};
  while (descent.Going()) {
    const double loss = 1 + std::abs(x[0] - 1) + x[1] * x[1];
    const std::vector<float> gradient{x[0] > 1 ? 1.0f : -1.0f, 2 * x[1]};
    descent.Step(loss, gradient, x);
  }
  EXPECT_TRUE(descent.converged());
  EXPECT_LT(descent.losses().size(), 1000u);
  EXPECT_LT(descent.best_loss(), 1.02);
  EXPECT_NEAR(descent.best()[0], 1.0, 0.02);
}

TEST(Descent, ALossThatIsNotFiniteIsReported) {
  Descent descent({10, 0.1, 1e-3, 20}, 1);
  std::vector<float> x{0};
  const std::vector<float> gradient{0};
  EXPECT_THROW(descent.Step(std::nan(""), gradient, x), std::runtime_error);
}

TEST(Levels, HalveDownToTheCoarseSize) {
  using Sizes = std::vector<std::pair<int, int>>;
  EXPECT_EQ(LevelSizes(256, 256, 256, 1 << 20), (Sizes{{256, 256}}));
  EXPECT_EQ(LevelSizes(1000, 401, 256, 1 << 20), (Sizes{{250, 101}, {500, 201}, {1000, 401}}));
  EXPECT_EQ(LevelSizes(7, 5, 256, 1 << 20), (Sizes{{7, 5}}));
  EXPECT_EQ(LevelSizes(1000, 401, 256, 600), (Sizes{{250, 101}, {500, 201}}));
  EXPECT_EQ(LevelSizes(1000, 401, 256, 256), (Sizes{{250, 101}}));
}

TEST(Levels, EnlargedMapsShowTheSame) {
  const EncodedMaps maps = EncodeMaps(UniformMaps(16, 0.3f, 0.1f, 0.4f));
  const EncodedMaps large = Resized(maps, 33, 20);
  for (int p = 0; p < kEncodedChannels; ++p) {
    for (size_t i = 0; i < large.texels(); ++i) {
      EXPECT_NEAR(large.planes[p * large.texels() + i], maps.planes[p * maps.texels()], 1e-6);
    }
  }
  const EncodedMaps textured = EncodeMaps(ToyMaterial(1, 32, 32));
  const EncodedMaps there = Resized(Resized(textured, 64, 64), 32, 32);
  double error = 0;
  for (size_t i = 0; i < there.planes.size(); ++i) {
    error +=
        std::abs(there.planes[i] - textured.planes[i]) / static_cast<double>(there.planes.size());
  }
  EXPECT_LT(error, 0.03);
}

}  // namespace
}  // namespace glint
