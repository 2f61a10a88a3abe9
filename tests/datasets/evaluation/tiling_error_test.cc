#include "datasets/evaluation/tiling_error.h"

#include <gtest/gtest.h>

#include "datasets/procedural/material.h"

namespace glint {
namespace {

constexpr int kSize = 48;

SvbrdfMaps Wood() { return MakeMaterial("wood", 5, kSize, kSize); }

TEST(CompareTile, FindsNoDifferenceInASampleMadeOfTheTile) {
  const SvbrdfMaps tile = Wood();
  const TilingErrors errors = CompareTile(tile, Repeated(tile, 3, 2), 2);
  EXPECT_LT(errors.largest_mean, 1e-3);
  EXPECT_LT(errors.largest_spread, 1e-3);
}

TEST(CompareTile, AMatteTileDarkerByATenthDiffersByATenth) {
  SvbrdfMaps sample = Wood();
  for (int c = 0; c < 3; ++c) {
    for (float& value : sample.plane(kSpecularR + c)) value = 0;
  }
  SvbrdfMaps tile = sample;
  for (int c = 0; c < 3; ++c) {
    for (float& value : tile.plane(kDiffuseR + c)) value *= 0.9f;
  }
  const TilingErrors errors = CompareTile(tile, sample, 1);
  // Fresnel's term shines at grazing light without any specular albedo.
  EXPECT_NEAR(errors.mean, 0.1, 0.02);
  EXPECT_LE(errors.mean, errors.largest_mean);
  EXPECT_LE(errors.spread, errors.largest_spread);
}

TEST(CompareTile, DoesNotDependOnThreads) {
  const SvbrdfMaps sample = Wood();
  const SvbrdfMaps tile = MakeMaterial("wood", 6, kSize, kSize);
  EXPECT_EQ(CompareTile(tile, sample, 1).spread, CompareTile(tile, sample, 3).spread);
}

}  // namespace
}  // namespace glint
