#include "datasets/procedural/finish.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "datasets/procedural/blend.h"
#include "datasets/procedural/material.h"
#include "tests/datasets/procedural/measures.h"

namespace glint {
namespace {

constexpr int kSide = 128;

SvbrdfMaps Make(const std::string& family, uint64_t seed, bool finished) {
  return MakeMaterial(MaterialRecipe{seed, family, "", finished}, kSide, kSide);
}

// Part of a plane's contrast that neighbours do not share.
double TexelShare(std::span<const float> plane) {
  double square = 0;
  for (int y = 0; y < kSide; ++y) {
    for (int x = 0; x + 1 < kSide; ++x) {
      const double step =
          plane[static_cast<size_t>(y) * kSide + x + 1] - plane[static_cast<size_t>(y) * kSide + x];
      square += step * step;
    }
  }
  return std::sqrt(square / (kSide * (kSide - 1))) / std::max(Spread(plane), 1e-3);
}

double Median(std::vector<double> values) {
  std::nth_element(values.begin(), values.begin() + values.size() / 2, values.end());
  return values[values.size() / 2];
}

template <typename Measure>
std::vector<double> OverFamilies(bool finished, Measure measure) {
  std::vector<double> values;
  for (const std::string& family : MaterialFamilies()) {
    for (uint64_t seed = 0; seed < 3; ++seed)
      values.push_back(measure(Make(family, seed, finished)));
  }
  return values;
}

TEST(FinishTest, TheFamilysOwnLookDoesNotDependOnFinishing) {
  EXPECT_EQ(Make("leather", 3, false).planes, MakeMaterial("leather", 3, kSide, kSide).planes);
  EXPECT_NE(Make("leather", 3, true).planes, Make("leather", 3, false).planes);
  EXPECT_EQ(Make("leather", 3, true).planes, Make("leather", 3, true).planes);
}

TEST(FinishTest, FinishedSurfacesHaveMoreDetailOfTexelSizeAndLessContrast) {
  const auto detail = [](const SvbrdfMaps& maps) { return TexelShare(maps.plane(kDiffuseG)); };
  EXPECT_GT(Median(OverFamilies(true, detail)), 1.3 * Median(OverFamilies(false, detail)));
  const auto rough = [](const SvbrdfMaps& maps) { return Spread(maps.plane(kRoughness)); };
  EXPECT_LT(Median(OverFamilies(true, rough)), 0.9 * Median(OverFamilies(false, rough)));
}

TEST(FinishTest, LargerPicturesShowTheSameMaterial) {
  double same = 0, other = 0;
  for (uint64_t seed = 0; seed < 12; ++seed) {
    MaterialRecipe recipe = DrawRecipe(seed);
    recipe.finished = true;
    const SvbrdfMaps coarse = MakeMaterial(recipe, 256, 256);
    same += MeanDifference(Halved(MakeMaterial(recipe, 512, 512)), coarse);
    ++recipe.seed;
    other += MeanDifference(MakeMaterial(recipe, 256, 256), coarse);
  }
  EXPECT_LT(same, 0.35 * other);
}

TEST(FinishTest, LightPlacesAreMoreOftenSmoothThanRough) {
  const auto correlation = [](const SvbrdfMaps& maps) {
    const auto a = maps.plane(kDiffuseG), b = maps.plane(kRoughness);
    const double ma = Mean(a), mb = Mean(b);
    double sum = 0;
    for (size_t i = 0; i < a.size(); ++i) sum += (a[i] - ma) * (b[i] - mb);
    return sum / static_cast<double>(a.size()) / std::max(Spread(a) * Spread(b), 1e-6);
  };
  const std::vector<double> all = OverFamilies(true, correlation);
  EXPECT_LT(Median(all), -0.02);
  EXPECT_GT(std::count_if(all.begin(), all.end(), [](double c) { return c < -0.6; }), 8);
  EXPECT_GT(std::count_if(all.begin(), all.end(), [](double c) { return c > 0.4; }), 4);
}

TEST(FinishTest, ALevelPlaneStaysLevelAtItsBorder) {
  procedural::LayerPlanes planes(32, 24);
  for (procedural::Plane* plane : {&planes.r, &planes.g, &planes.b, &planes.roughness}) {
    std::fill(plane->begin(), plane->end(), 0.4f);
  }
  for (procedural::Plane* plane : {&planes.heights, &planes.metal, &planes.f0}) {
    std::fill(plane->begin(), plane->end(), 0.0f);
  }
  procedural::FinishSurface(5, 0.0f, &planes);  // slope 0: no relief to add
  for (const float h : planes.heights) ASSERT_EQ(h, 0.0f);
  for (const float r : planes.r) ASSERT_TRUE(r >= 0.0f && r < 1.5f);
}

TEST(BlendTest, ReconciledMaterialsAreNearerAndStayWithinEnergy) {
  const SvbrdfMaps first = MakeMaterial("plaster", 1, kSide, kSide);
  int nearer = 0;
  for (uint64_t seed = 0; seed < 20; ++seed) {
    const SvbrdfMaps before = MakeMaterial("stone", seed, kSide, kSide);
    SvbrdfMaps after = before;
    procedural::Reconcile(seed, first, &after);
    const double target = Mean(first.plane(kDiffuseG));
    const double was = std::fabs(Mean(before.plane(kDiffuseG)) - target);
    const double is = std::fabs(Mean(after.plane(kDiffuseG)) - target);
    EXPECT_LE(is, was + 1e-3) << seed;
    nearer += is < 0.9 * was ? 1 : 0;
    for (size_t i = 0; i < after.texels(); ++i) {
      for (int c = 0; c < 3; ++c) {
        ASSERT_LE(after.plane(kDiffuseR + c)[i] + after.plane(kSpecularR + c)[i], 1.00001f);
      }
    }
  }
  EXPECT_GE(nearer, 8);
}

TEST(BlendTest, MasksAreWeights) {
  const SvbrdfMaps first = MakeMaterial("bricks", 1, kSide, kSide);
  int varied = 0;
  for (uint64_t seed = 0; seed < 60; ++seed) {
    const procedural::Plane mask = procedural::DrawBlendMask(seed, first);
    ASSERT_EQ(mask.size(), first.texels());
    for (const float w : mask) ASSERT_TRUE(w >= 0.0f && w <= 1.0f) << seed;
    varied += Spread(mask) > 0.05 ? 1 : 0;
  }
  EXPECT_GT(varied, 35);  // the others are constant
  EXPECT_LT(varied, 58);
}

}  // namespace
}  // namespace glint
