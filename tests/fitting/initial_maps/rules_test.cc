#include "fitting/initial_maps/rules.h"

#include <gtest/gtest.h>

#include <limits>
#include <numeric>

#include "tests/fitting/initial_maps/synthetic_set.h"
#include "tests/training/toy_materials.h"

namespace glint {
namespace {

using test::PhotographMaps;
using test::UniformMaps;

double MeanError(const SvbrdfMaps& a, const SvbrdfMaps& b, int plane) {
  double sum = 0;
  for (size_t i = 0; i < a.texels(); ++i) sum += std::abs(a.plane(plane)[i] - b.plane(plane)[i]);
  return sum / static_cast<double>(a.texels());
}

TEST(Lobes, OfAUniformSampleAreFound) {
  for (const float roughness : {0.25f, 0.4f, 0.6f}) {
    const SvbrdfMaps truth = UniformMaps(64, 0.3f, 0.06f, roughness);
    const GlobalLobes lobes = FitGlobalLobes(PhotographMaps(truth, 5));
    EXPECT_NEAR(lobes.roughness, roughness, 0.08);
    EXPECT_NEAR(lobes.specular[0], 0.06, 0.03);
    EXPECT_NEAR(lobes.diffuse[0], 0.3, 0.03);
    EXPECT_NEAR(lobes.diffuse[2], 0.18, 0.03);
  }
}

TEST(Lobes, WithoutAHighlightInViewAreTheTypicalOnes) {
  const SvbrdfMaps truth = UniformMaps(32, 0.3f, 0.04f, 0.3f);
  PhotographSet set = PhotographMaps(truth, 1);
  Photograph& photo = set.photographs[0];
  photo.view = DirView(0, 0);
  photo.view.camera_in_sample_mm = {0, 0, 3};
  photo.view.light_in_sample_mm = {30, 0, 10};  // half vectors at 36° and more
  RenderView(truth, set.plane, photo.view, set.convention, photo.rgb.data());
  const GlobalLobes lobes = FitGlobalLobes(set);
  EXPECT_GT(lobes.roughness, 0.2);
  EXPECT_LT(lobes.roughness, 0.6);
  EXPECT_LT(lobes.specular[0], 0.2);
  EXPECT_NEAR(lobes.diffuse[0], 0.3, 0.08);
}

TEST(Lobes, OfAPolishedUnevenSampleAreSharp) {
  SvbrdfMaps truth = UniformMaps(128, 0.05f, 0.04f, 0.08f);
  Stream random(8);
  for (size_t i = 0; i < truth.texels(); ++i) {  // slopes of about 2°
    const double x = 0.035 * random.Normal(), y = 0.035 * random.Normal();
    const double z = 1 / std::sqrt(1 + x * x + y * y);
    truth.plane(kNormalX)[i] = static_cast<float>(x * z);
    truth.plane(kNormalY)[i] = static_cast<float>(y * z);
    truth.plane(kNormalZ)[i] = static_cast<float>(z);
  }
  for (const int count : {1, 5}) {
    EXPECT_LT(FitGlobalLobes(PhotographMaps(truth, count)).roughness, 0.2) << count;
  }
}

TEST(RuleBasedMaps, DiffuseTextureIsFound) {
  SvbrdfMaps truth = UniformMaps(64, 0.3f, 0.04f, 0.5f);
  for (int row = 0; row < 64; ++row) {
    for (int column = 0; column < 32; ++column) truth.at(kDiffuseR, row, column) = 0.1f;
  }
  for (const int count : {1, 5}) {
    const SvbrdfMaps maps = EstimateMaps(PhotographMaps(truth, count), 1);
    EXPECT_LT(MeanError(maps, truth, kDiffuseR), 0.05) << count;
  }
}

TEST(RuleBasedMaps, NormalsOfAMattSampleComeFromManyPhotographs) {
  SvbrdfMaps truth = UniformMaps(32, 0.4f, 0.02f, 0.8f);
  for (int row = 0; row < 32; ++row) {
    for (int column = 0; column < 32; ++column) {
      const float slope = column < 16 ? 0.3f : -0.3f;
      const float z = 1 / std::sqrt(1 + slope * slope);
      truth.at(kNormalX, row, column) = slope * z;
      truth.at(kNormalZ, row, column) = z;
    }
  }
  const double flat = MeanError(UniformMaps(32, 0.4f, 0.02f, 0.8f), truth, kNormalX);
  EXPECT_LT(MeanError(EstimateMaps(PhotographMaps(truth, 12), 1), truth, kNormalX), 0.4 * flat);
  EXPECT_NEAR(MeanError(EstimateMaps(PhotographMaps(truth, 2), 1), truth, kNormalX), flat, 1e-6);
}

TEST(RuleBasedMaps, IsCloserToTheTruthThanADefault) {
  double estimate = 0, plain = 0;
  for (std::uint64_t k = 0; k < 6; ++k) {
    const SvbrdfMaps truth = ToyMaterial(k, 48, 48);
    const SvbrdfMaps maps = EstimateMaps(PhotographMaps(truth, 5), 1);
    const SvbrdfMaps guess = UniformMaps(48, 0.5f, 0.04f, 0.4f);
    for (int c = 0; c < 3; ++c) {
      estimate += MeanError(maps, truth, kDiffuseR + c);
      plain += MeanError(guess, truth, kDiffuseR + c);
    }
  }
  EXPECT_LT(estimate, 0.7 * plain);
}

TEST(RuleBasedMaps, DoesNotDependOnTheOrderOfPhotographsOrThreads) {
  PhotographSet set = PhotographMaps(ToyMaterial(3, 40, 24), 5);
  const SvbrdfMaps maps = EstimateMaps(set, 1);
  EXPECT_EQ(maps.planes, EstimateMaps(set, 2).planes);
  std::reverse(set.photographs.begin(), set.photographs.end());
  const SvbrdfMaps reversed = EstimateMaps(set, 1);
  for (size_t i = 0; i < maps.planes.size(); ++i) {
    EXPECT_NEAR(maps.planes[i], reversed.planes[i], 1e-4) << i;
  }
}

TEST(RuleBasedMaps, MaskedTexelsMayHoldAnything) {
  PhotographSet set = PhotographMaps(ToyMaterial(3, 40, 24), 2);
  PhotographSet spoilt = set;
  for (PhotographSet* s : {&set, &spoilt}) {
    for (int i = 0; i < 200; ++i) s->photographs[0].mask[i] = 0;
    for (int i = 100; i < 300; ++i) s->photographs[1].mask[i] = 0;
  }
  for (int i = 0; i < 200; ++i) {
    spoilt.photographs[0].rgb[i] = std::numeric_limits<float>::quiet_NaN();
  }
  EXPECT_EQ(spoilt.Check(), "");
  const SvbrdfMaps maps = EstimateMaps(set, 1);
  EXPECT_EQ(maps.planes, EstimateMaps(spoilt, 1).planes);
  for (const float x : maps.planes) ASSERT_TRUE(std::isfinite(x));
}

TEST(PhotographSet, SaysWhatIsWrong) {
  const PhotographSet good = PhotographMaps(ToyMaterial(1, 8, 8), 2);
  EXPECT_EQ(good.Check(), "");
  PhotographSet none = good, size = good, dark = good, bad = good;
  none.photographs.clear();
  EXPECT_NE(none.Check(), "");
  size.photographs[1].rgb.pop_back();
  EXPECT_NE(size.Check(), "");
  for (Photograph& photo : dark.photographs) photo.mask.assign(64, 0.0f);
  EXPECT_NE(dark.Check(), "");
  bad.photographs[0].rgb[5] = std::numeric_limits<float>::infinity();
  EXPECT_NE(bad.Check(), "");
}

}  // namespace
}  // namespace glint
