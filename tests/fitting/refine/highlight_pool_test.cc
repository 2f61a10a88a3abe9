#include "fitting/refine/highlight_pool.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/fitting/refine/synthetic_scene.h"

namespace glint {
namespace {

constexpr int kSize = 48;

// Left half dark, right half bright; one roughness each.
SvbrdfMaps TwoHalves(float left_roughness, float right_roughness) {
  SvbrdfMaps maps(kSize, kSize);
  for (int row = 0; row < kSize; ++row) {
    for (int column = 0; column < kSize; ++column) {
      const bool left = column < kSize / 2;
      maps.at(kNormalZ, row, column) = 1;
      for (int c = 0; c < 3; ++c) {
        maps.at(kDiffuseR + c, row, column) = left ? 0.1f : 0.5f;
        maps.at(kSpecularR + c, row, column) = left ? 0.04f : 0.1f;
      }
      maps.at(kRoughness, row, column) = left ? left_roughness : right_roughness;
    }
  }
  return maps;
}

RefineResult Sure(const SvbrdfMaps& maps, float sigma) {
  RefineResult result;
  result.maps = maps;
  result.confidence.assign(maps.texels() * kConfidencePlanes, sigma);
  return result;
}

TEST(PoolHighlights, TheSureTeachTheUnsure) {
  RefineResult refined = Sure(TwoHalves(0.3f, 0.3f), 0.01f);
  const size_t unsure = 10 * kSize + 10;
  refined.maps.plane(kRoughness)[unsure] = 0.8f;
  refined.confidence[kSigmaRoughness * refined.maps.texels() + unsure] = 0.2f;
  const HighlightPool pool = PoolHighlights(refined, {}, 1);
  EXPECT_NEAR(pool.start.plane(kRoughness)[unsure], 0.3, 0.01);
  EXPECT_LT(pool.roughness_error[unsure], 0.08);
}

TEST(PoolHighlights, UnlikeColoursDoNotMix) {
  const HighlightPool pool = PoolHighlights(Sure(TwoHalves(0.2f, 0.7f), 0.05f), {}, 1);
  const int beside = kSize / 2 - 1;
  EXPECT_NEAR(pool.start.at(kRoughness, 20, beside), 0.2, 1e-3);
  EXPECT_NEAR(pool.start.at(kRoughness, 20, beside + 1), 0.7, 1e-3);
  EXPECT_NEAR(pool.start.at(kSpecularG, 20, beside), 0.04, 1e-3);
}

TEST(PoolHighlights, WhatVariesNearbyIsHeldLessFirmly) {
  RefineResult refined = Sure(TwoHalves(0.3f, 0.3f), 0.01f);
  for (int row = 0; row < kSize; ++row) {
    for (int column = kSize / 2; column < kSize; ++column) {
      refined.maps.at(kRoughness, row, column) = (row * 7 + column * 3) % 5 < 2 ? 0.2f : 0.6f;
    }
  }
  const HighlightPool pool = PoolHighlights(refined, {}, 1);
  EXPECT_GT(pool.roughness_error[20 * kSize + kSize - 6], 4 * pool.roughness_error[20 * kSize + 5]);
}

// Unsure values vary by their own uncertainty; that is no reason to hold their mean less firmly.
TEST(PoolHighlights, NoiseOfTheTexelsIsNotTakenForVariety) {
  RefineResult refined = Sure(TwoHalves(0.4f, 0.4f), 0.01f);
  const auto roughness = refined.maps.plane(kRoughness);
  for (size_t t = 0; t < refined.maps.texels(); ++t) roughness[t] += t % 2 ? 0.1f : -0.1f;
  const float certain = PoolHighlights(refined, {}, 1).roughness_error[20 * kSize + 5];
  refined.confidence.assign(refined.confidence.size(), 0.1f);
  const float noisy = PoolHighlights(refined, {}, 1).roughness_error[20 * kSize + 5];
  EXPECT_GT(certain, 0.1);
  EXPECT_LT(noisy, 0.5 * certain);
}

TEST(PoolHighlights, KeepsNormalsAndDiffuseAndIsTheSameForAnyThreads) {
  const RefineResult refined = Sure(TwoHalves(0.2f, 0.7f), 0.05f);
  const HighlightPool one = PoolHighlights(refined, {}, 1), three = PoolHighlights(refined, {}, 3);
  EXPECT_EQ(one.start.planes, three.start.planes);
  EXPECT_EQ(one.roughness_error, three.roughness_error);
  EXPECT_EQ(one.specular_error, three.specular_error);
  EXPECT_TRUE(std::equal(one.start.planes.begin(),
                         one.start.planes.begin() + kSpecularR * kSize * kSize,
                         refined.maps.planes.begin()));
}

TEST(Refine, TexelsWithoutAHighlightLearnTheirNeighbours) {
  const SvbrdfMaps truth = TwoHalves(0.35f, 0.35f);
  const test::SyntheticScene scene = test::Photograph(truth, 6, 8);
  SvbrdfMaps start = truth;
  for (float& r : start.plane(kRoughness)) r = 0.5f;
  const auto error = [&](int passes) {
    RefineOptions options;
    options.pooling_passes = passes;
    const RefineResult result = Refine(scene.Problem(), start, options, 1);
    double squares = 0;
    for (const float r : result.maps.plane(kRoughness)) squares += (r - 0.35) * (r - 0.35);
    return squares;
  };
  EXPECT_LT(error(2), 0.85 * error(0));
}

}  // namespace
}  // namespace glint
