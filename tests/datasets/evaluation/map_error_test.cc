#include "datasets/evaluation/map_error.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "datasets/procedural/material.h"

namespace glint {
namespace {

SvbrdfMaps SmallMaterial(std::uint64_t seed = 12, int size = 32) {
  return MakeMaterial(seed, size, size);
}

void Shift(SvbrdfMaps* maps, int first_plane, int last_plane, float by) {
  for (int p = first_plane; p <= last_plane; ++p) {
    for (float& value : maps->plane(p)) value += by;
  }
}

TEST(CompareMaps, IdenticalMapsHaveNoError) {
  const MapErrors errors = CompareMaps(SmallMaterial(), SmallMaterial());
  EXPECT_EQ(errors.diffuse, 0);
  EXPECT_EQ(errors.specular, 0);
  EXPECT_EQ(errors.roughness, 0);
  EXPECT_EQ(errors.normal, 0);
  EXPECT_EQ(errors.average(), 0);
}

TEST(CompareMaps, AnOffsetGivesItsSquareInItsOwnFigureAlone) {
  const SvbrdfMaps truth = SmallMaterial();
  SvbrdfMaps estimate = truth;
  Shift(&estimate, kDiffuseR, kDiffuseB, 0.1f);
  EXPECT_NEAR(CompareMaps(estimate, truth).diffuse, 0.01, 1e-6);
  EXPECT_EQ(CompareMaps(estimate, truth).specular, 0);
  EXPECT_NEAR(CompareMaps(estimate, truth).average(), 0.0025, 1e-6);

  estimate = truth;
  Shift(&estimate, kSpecularG, kSpecularG, 0.3f);  // one channel of three
  EXPECT_NEAR(CompareMaps(estimate, truth).specular, 0.03, 1e-6);

  estimate = truth;
  Shift(&estimate, kRoughness, kRoughness, -0.2f);
  EXPECT_NEAR(CompareMaps(estimate, truth).roughness, 0.04, 1e-6);

  estimate = truth;
  Shift(&estimate, kNormalX, kNormalZ, 0.2f);  // (n + 1)/2 moves by 0.1
  EXPECT_NEAR(CompareMaps(estimate, truth).normal, 0.01, 1e-6);
}

TEST(CompareMaps, IsSymmetricAndDoesNotDependOnTheOrderOfTexels) {
  const SvbrdfMaps a = SmallMaterial(1), b = SmallMaterial(2);
  const auto reversed = [](SvbrdfMaps maps) {
    for (int p = 0; p < kSvbrdfPlanes; ++p) std::ranges::reverse(maps.plane(p));
    return maps;
  };
  const MapErrors errors = CompareMaps(a, b), back = CompareMaps(b, a);
  const MapErrors turned = CompareMaps(reversed(a), reversed(b));
  EXPECT_GT(errors.average(), 0);
  EXPECT_EQ(errors.average(), back.average());
  EXPECT_NEAR(errors.average(), turned.average(), 1e-12);
}

TEST(CompareMaps, DifferentSizesAreRefused) {
  EXPECT_THROW(CompareMaps(SmallMaterial(1, 16), SmallMaterial(1, 32)), std::invalid_argument);
  EXPECT_THROW(CompareMaps(SvbrdfMaps(), SvbrdfMaps()), std::invalid_argument);
}

TEST(NovelViews, AreIndependentCosineWeightedDirections) {
  const auto views = NovelViews(20000, 1);
  Vec3d mean_light{0, 0, 0}, mean_camera{0, 0, 0};
  double product = 0;
  for (const View& view : views) {
    for (int i = 0; i < 3; ++i) {
      mean_light[i] += view.light_in_sample_mm[i] / kDirHeight / views.size();
      mean_camera[i] += view.camera_in_sample_mm[i] / kDirHeight / views.size();
    }
    product += view.light_in_sample_mm[2] * view.camera_in_sample_mm[2] / kDirHeight / kDirHeight /
               views.size();
    EXPECT_GT(view.light_in_sample_mm[2], 0.173 * kDirHeight);
  }
  // E[cosθ] of a cosine-weighted direction is 2/3; without the lowest 10°, (2/3)(1 − s³)/(1 − s²).
  const double s = std::sin(10 * M_PI / 180);
  const double expected = 2.0 / 3 * (1 - s * s * s) / (1 - s * s);
  EXPECT_NEAR(mean_light[2], expected, 0.01);
  EXPECT_NEAR(mean_camera[2], expected, 0.01);
  EXPECT_NEAR(mean_light[0], 0, 0.02);
  EXPECT_NEAR(mean_camera[1], 0, 0.02);
  EXPECT_NEAR(product, expected * expected, 0.01);
}

TEST(NovelViews, FollowFromTheSeed) {
  EXPECT_EQ(NovelViews(5, 7)[4].light_in_sample_mm, NovelViews(9, 7)[4].light_in_sample_mm);
  EXPECT_NE(NovelViews(5, 7)[4].light_in_sample_mm, NovelViews(5, 8)[4].light_in_sample_mm);
}

TEST(RenderError, IsZeroForTheSameMapsAndPositiveForOthers) {
  const auto views = NovelViews(10, 3);
  const SvbrdfMaps truth = SmallMaterial();
  EXPECT_EQ(RenderError(truth, truth, views, 1), 0);
  SvbrdfMaps swapped = truth;
  std::ranges::swap_ranges(swapped.plane(kNormalX), swapped.plane(kNormalY));
  EXPECT_GT(RenderError(swapped, truth, views, 1), 1e-6);
}

// A matt plane under one overhead light: radiance is k_d·(E/π)·cosθ with E = π.
TEST(RenderError, OfAMattPlaneIsTheSquareOfItsRadiance) {
  SvbrdfMaps black(9, 9), grey(9, 9);
  for (SvbrdfMaps* maps : {&black, &grey}) {
    std::ranges::fill(maps->plane(kNormalZ), 1.0f);
    std::ranges::fill(maps->plane(kRoughness), 1.0f);
  }
  Shift(&grey, kDiffuseR, kDiffuseB, 0.5f);
  View view = DirView(0, 0);
  view.light_in_sample_mm = {0, 0, 1e6};  // parallel light: cosθ = 1 everywhere
  EXPECT_NEAR(RenderError(grey, black, {view}, 1), 0.25, 1e-5);
  // Clipped: 4 times the light drives the grey plane to 2, which counts as 1.
  for (double& power : view.light_rgb) power *= 4;
  EXPECT_NEAR(RenderError(grey, black, {view}, 1), 1, 1e-3);
}

TEST(RenderError, DoesNotDependOnThreads) {
  const auto views = NovelViews(4, 3);
  const SvbrdfMaps a = SmallMaterial(1, 64), b = SmallMaterial(2, 64);
  EXPECT_EQ(RenderError(a, b, views, 1), RenderError(a, b, views, 3));
}

TEST(EvaluateMaps, GivesAllSixFigures) {
  const Table1Row row = EvaluateMaps(SmallMaterial(1), SmallMaterial(2), 1);
  EXPECT_GT(row.maps.diffuse, 0);
  EXPECT_GT(row.render, 0);
  EXPECT_EQ(row.render,
            RenderError(SmallMaterial(1), SmallMaterial(2), NovelViews(100, kNovelSeed), 1));
}

}  // namespace
}  // namespace glint
