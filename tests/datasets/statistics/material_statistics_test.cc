#include "datasets/statistics/material_statistics.h"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

namespace glint {
namespace {

constexpr int kSide = 64;

SvbrdfMaps Flat() {
  SvbrdfMaps maps(kSide, kSide);
  for (size_t i = 0; i < maps.texels(); ++i) {
    maps.plane(kNormalZ)[i] = 1;
    for (int c = 0; c < 3; ++c) {
      maps.plane(kDiffuseR + c)[i] = 0.25f;
      maps.plane(kSpecularR + c)[i] = 0.04f;
    }
    maps.plane(kRoughness)[i] = 0.5f;
  }
  return maps;
}

// Bumps whose tops are light and glossy.
SvbrdfMaps Bumps() {
  SvbrdfMaps maps = Flat();
  const float turn = 2 * static_cast<float>(M_PI) * 8 / kSide;
  for (int y = 0; y < kSide; ++y) {
    for (int x = 0; x < kSide; ++x) {
      const float height = std::sin(turn * static_cast<float>(x));
      const float slope = turn * std::cos(turn * static_cast<float>(x));
      const float z = 1 / std::sqrt(1 + slope * slope);
      maps.at(kNormalX, y, x) = -slope * z;
      maps.at(kNormalZ, y, x) = z;
      maps.at(kRoughness, y, x) = 0.5f - 0.2f * height;
      for (int c = 0; c < 3; ++c) maps.at(kDiffuseR + c, y, x) = 0.3f + 0.2f * height;
    }
  }
  return maps;
}

TEST(MaterialStatisticsTest, AFlatMaterialHasMeansAndNoSpread) {
  const MaterialStatistics m = MeasureMaterial(Flat());
  EXPECT_NEAR(m[Trait::kDiffuseMean], std::pow(0.25, 1 / 2.2), 1e-5);
  EXPECT_NEAR(m[Trait::kRoughnessMean], 0.5, 1e-6);
  EXPECT_NEAR(m[Trait::kF0Mean], 0.04, 1e-6);
  EXPECT_NEAR(m[Trait::kTiltMean], 0, 1e-6);
  EXPECT_NEAR(m[Trait::kDiffuseContrast], 0, 1e-5);
  EXPECT_NEAR(m[Trait::kSaturationMean], 0, 1e-6);
  EXPECT_TRUE(std::isnan(m[Trait::kHeightDiffuse]));
}

TEST(MaterialStatisticsTest, HistogramsSumToOneAndStandAtTheValues) {
  const MaterialStatistics m = MeasureMaterial(Flat());
  for (const auto& histogram : m.histogram) {
    double sum = 0;
    for (const double share : histogram) sum += share;
    EXPECT_NEAR(sum, 1, 1e-9);
  }
  EXPECT_NEAR(m.histogram[static_cast<size_t>(Channel::kRoughness)][kHistogramBins / 2], 1, 1e-9);
}

TEST(MaterialStatisticsTest, RaisedLightAndGlossyTexelsCorrelate) {
  const MaterialStatistics m = MeasureMaterial(Bumps());
  EXPECT_GT(m[Trait::kHeightDiffuse], 0.97);
  EXPECT_LT(m[Trait::kHeightRoughness], -0.99);
  EXPECT_LT(m[Trait::kDiffuseRoughness], -0.97);
  EXPECT_GT(m[Trait::kSlopeDirectionality], 0.99);
}

TEST(MaterialStatisticsTest, ReliefPeaksAtItsFrequency) {
  const MaterialStatistics m = MeasureMaterial(Bumps());
  const auto& slope = m.spectrum[static_cast<size_t>(SpectrumOf::kSlope)];
  for (int band = 0; band < kSpectrumBands; ++band) {
    EXPECT_LE(slope[static_cast<size_t>(band)], slope[6]) << band;  // 8 cycles = 2^(6/2)
  }
}

TEST(MaterialStatisticsTest, SteepTiltIsWhatFewTexelsPass) {
  SvbrdfMaps maps = Flat();
  for (size_t i = 0; i < maps.texels() / 50; ++i) {  // 2 % of texels at 60°
    maps.plane(kNormalX)[i] = std::sqrt(0.75f);
    maps.plane(kNormalZ)[i] = 0.5f;
  }
  const MaterialStatistics m = MeasureMaterial(maps);
  EXPECT_NEAR(m[Trait::kTiltSteep], 60, 0.01);
  EXPECT_NEAR(m[Trait::kTiltMean], 1.2, 0.02);
}

TEST(MaterialStatisticsTest, RefusesSizesThatItCannotTransform) {
  EXPECT_THROW(MeasureMaterial(SvbrdfMaps(48, 48)), std::invalid_argument);
  EXPECT_THROW(MeasureMaterial(SvbrdfMaps(64, 32)), std::invalid_argument);
  EXPECT_THROW(MeasureMaterial(SvbrdfMaps()), std::invalid_argument);
}

}  // namespace
}  // namespace glint
