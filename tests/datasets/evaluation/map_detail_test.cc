#include "datasets/evaluation/map_detail.h"

#include <gtest/gtest.h>

#include <stdexcept>

#include "datasets/procedural/material.h"
#include "datasets/procedural/random.h"

namespace glint {
namespace {

SvbrdfMaps Material() { return MakeMaterial(12, 48, 48); }

SvbrdfMaps Blurred(const SvbrdfMaps& maps) {
  SvbrdfMaps blurred = maps;
  for (int p = 0; p < kSvbrdfPlanes; ++p) {
    for (int row = 1; row + 1 < maps.height; ++row) {
      for (int column = 1; column + 1 < maps.width; ++column) {
        float sum = 0;
        for (int dy = -1; dy <= 1; ++dy) {
          for (int dx = -1; dx <= 1; ++dx) sum += maps.at(p, row + dy, column + dx);
        }
        blurred.at(p, row, column) = sum / 9;
      }
    }
  }
  return blurred;
}

SvbrdfMaps Noisy(SvbrdfMaps maps, float strength) {
  procedural::Rng rng(3);
  for (float& value : maps.planes) value += rng.Uniform(-strength, strength);
  return maps;
}

TEST(CompareDetail, TheTruthHasAllOfIts) {
  const MapDetail detail = CompareDetail(Material(), Material());
  EXPECT_NEAR(detail.energy, 1, 1e-12);
  EXPECT_NEAR(detail.agreement, 1, 1e-12);
}

TEST(CompareDetail, BlurLowersEnergyAndNoiseRaisesIt) {
  const SvbrdfMaps truth = Material();
  EXPECT_LT(CompareDetail(Blurred(truth), truth).energy, 0.7);
  const MapDetail noisy = CompareDetail(Noisy(truth, 0.2f), truth);
  EXPECT_GT(noisy.energy, 1.2);
  EXPECT_LT(noisy.agreement, 0.95);
}

TEST(CompareDetail, HalfTheContrastIsAQuarterOfTheEnergyInFullAgreement) {
  const SvbrdfMaps truth = Material();
  SvbrdfMaps half = truth;
  for (float& value : half.planes) value *= 0.5f;
  const MapDetail detail = CompareDetail(half, truth);
  EXPECT_NEAR(detail.energy, 0.25, 1e-6);
  EXPECT_NEAR(detail.agreement, 1, 1e-6);
}

TEST(CompareDetail, DetailOfAnotherPlaceDoesNotAgree) {
  EXPECT_LT(CompareDetail(MakeMaterial(13, 48, 48), Material()).agreement, 0.5);
}

TEST(CompareDetail, FlatMapsAndOtherSizesAreNoTrap) {
  const SvbrdfMaps flat(8, 8);

  EXPECT_EQ(CompareDetail(flat, flat).energy, 0);
  EXPECT_THROW(CompareDetail(flat, SvbrdfMaps(8, 9)), std::invalid_argument);
  EXPECT_THROW(CompareDetail(SvbrdfMaps(1, 1), SvbrdfMaps(1, 1)), std::invalid_argument);
}

}  // namespace
}  // namespace glint
