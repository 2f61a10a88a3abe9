#include "datasets/synth/sensor.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/errors/errors.h"

namespace glint {
namespace {

TEST(EightBitEncoder, RoundsTheCurveAtEveryLevel) {
  for (const Encoding encoding : {Encoding::kGamma22, Encoding::kSrgb, Encoding::kLinear}) {
    const EightBitEncoder encoder(encoding);
    for (int i = 0; i <= 200000; ++i) {
      const float linear = static_cast<float>(i) / 200000;
      const double exact = 255.0 * EncodedFromLinear(encoding, linear);
      // Half a level, and what float thresholds may move it by.
      ASSERT_LE(std::abs(exact - encoder(linear)), 0.5 + 1e-3) << linear;
    }
  }
}

TEST(EightBitEncoder, KnownCodes) {
  const EightBitEncoder gamma(Encoding::kGamma22), srgb(Encoding::kSrgb);
  EXPECT_EQ(gamma(0.5f), 186);  // 255·0.5^(1/2.2) = 186.08
  EXPECT_EQ(srgb(0.5f), 188);   // 187.52
  EXPECT_EQ(gamma(-1.0f), 0);
  EXPECT_EQ(gamma(7.0f), 255);
  EXPECT_EQ(gamma(std::nanf("")), 0);
}

TEST(EightBitEncoder, DecodingACodeGivesItBack) {
  for (const Encoding encoding : {Encoding::kGamma22, Encoding::kSrgb, Encoding::kLinear}) {
    const EightBitEncoder encoder(encoding);
    const auto decoded = LinearTable(encoding, 256);
    for (int code = 0; code < 256; ++code) ASSERT_EQ(encoder(decoded[code]), code);
  }
}

TEST(BlurRows, SpreadsAPointByItsVarianceAndKeepsTheSum) {
  constexpr int kWidth = 7, kRows = 7;
  std::vector<float> rgb(3 * kWidth * kRows, 0.0f), blurred;
  rgb[3 * (3 * kWidth + 3) + 1] = 1;  // green, in the middle
  BlurRows(rgb, kWidth, kRows, 0.6, &blurred);
  ASSERT_EQ(blurred.size(), 3u * kWidth * (kRows - 2));
  double sum = 0, variance_x = 0, variance_y = 0;
  for (int y = 0; y < kRows - 2; ++y) {
    for (int x = 0; x < kWidth; ++x) {
      const float value = blurred[3 * (y * kWidth + x) + 1];
      sum += value;
      variance_x += value * (x - 3) * (x - 3);
      variance_y += value * (y - 2) * (y - 2);
      EXPECT_EQ(blurred[3 * (y * kWidth + x)], 0);  // red stays out of it
    }
  }
  EXPECT_NEAR(sum, 1, 1e-6);
  EXPECT_NEAR(variance_x, 0.36, 1e-6);
  EXPECT_NEAR(variance_y, 0.36, 1e-6);
}

TEST(BlurRows, KeepsAnEvenPictureUpToItsBorder) {
  const std::vector<float> rgb(3 * 5 * 4, 0.25f);
  std::vector<float> blurred;
  BlurRows(rgb, 5, 4, 0.8, &blurred);
  for (const float value : blurred) EXPECT_NEAR(value, 0.25f, 1e-7);
}

TEST(SensorNoise, HasTheStatedMomentsAndNoBias) {
  const SensorNoise noise;
  for (const float radiance : {0.02f, 0.3f, 0.9f}) {
    constexpr int kDraws = 200000;
    double sum = 0, squares = 0;
    for (int i = 0; i < kDraws; ++i) {
      const double deviation = NoisyRadiance(radiance, noise, 5, i) - radiance;
      sum += deviation;
      squares += deviation * deviation;
    }
    const double sigma = std::sqrt(radiance * noise.full_well_electrons +
                                   noise.read_electrons * noise.read_electrons) /
                         noise.full_well_electrons;
    EXPECT_NEAR(sum / kDraws, 0, 5 * sigma / std::sqrt(kDraws));
    EXPECT_NEAR(std::sqrt(squares / kDraws), sigma, 0.01 * sigma);
  }
}

TEST(SensorNoise, ScaleZeroChangesNothing) {
  SensorNoise noise;
  noise.scale = 0;
  EXPECT_EQ(NoisyRadiance(0.25f, noise, 1, 2), 0.25f);
}

TEST(Encoding, UnknownNameIsAUserError) { EXPECT_THROW(ParseEncoding("gamma"), UserError); }

}  // namespace
}  // namespace glint
