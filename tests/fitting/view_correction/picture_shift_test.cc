#include "fitting/photographs/picture_shift.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

namespace glint {
namespace {

constexpr int kSize = 16;

CornerShifts Uniform(double column, double row) {
  CornerShifts shifts;
  for (int k = 0; k < 4; ++k) {
    shifts.column[k] = column;
    shifts.row[k] = row;
  }
  return shifts;
}

TEST(CornerShifts, HaveTheLengthThatAllCornersShare) {
  EXPECT_DOUBLE_EQ(Uniform(0.3, -0.4).rms(), 0.5);
  EXPECT_EQ(CornerShifts().rms(), 0);
}

TEST(ShiftPicture, MovesARampByTheShift) {
  std::vector<float> ramp(3 * kSize * kSize);
  for (size_t i = 0; i < ramp.size(); ++i) {
    const size_t texel = i % (kSize * kSize);
    ramp[i] = static_cast<float>(10 * (texel % kSize) + texel / kSize);
  }
  const std::vector<float> before = ramp;
  ShiftPicture(Uniform(0.3, -0.2), kSize, kSize, &ramp);
  for (int y = 3; y < kSize - 3; ++y) {
    for (int x = 3; x < kSize - 3; ++x) {
      const auto i = static_cast<size_t>(y * kSize + x);
      EXPECT_NEAR(ramp[i] - before[i], 10 * 0.3 - 0.2, 1e-4);
    }
  }
}

TEST(NoiseLeft, IsTheShareOfItsVarianceThatAMovedPictureKeeps) {
  constexpr int kNoiseSize = 256;
  EXPECT_EQ(NoiseLeft(Uniform(1, -2)), 1);
  std::mt19937 random(5);
  std::vector<float> noise(3 * kNoiseSize * kNoiseSize);
  for (float& x : noise) x = static_cast<float>(1 + 1e-9 * random());
  const auto variance = [](const std::vector<float>& values) {
    double sum = 0, squares = 0;
    for (const double x : values) {
      sum += x;
      squares += x * x;
    }
    const double count = static_cast<double>(values.size());
    return squares / count - sum * sum / (count * count);
  };
  for (const CornerShifts& shifts : {Uniform(0.3, -0.2), Uniform(0.5, 0.5), Uniform(0, 0.1)}) {
    std::vector<float> moved = noise;
    ShiftPicture(shifts, kNoiseSize, kNoiseSize, &moved);
    EXPECT_NEAR(variance(moved) / variance(noise), NoiseLeft(shifts), 0.02);
  }
}

TEST(LookUp, DerivativesAreThoseOfItsValue) {
  std::vector<float> plane(kSize * kSize);
  for (size_t i = 0; i < plane.size(); ++i) {
    plane[i] = static_cast<float>(std::sin(0.7 * static_cast<double>(i % kSize)) +
                                  std::cos(0.4 * static_cast<double>(i / kSize)));
  }
  const auto value = [&](double column, double row) {
    return LookUp(plane.data(), kSize, kSize, column, row).value;
  };
  for (const double at : {4.1, 7.6, 9.99}) {
    const LookedUp found = LookUp(plane.data(), kSize, kSize, at, at + 0.3);
    const double h = 1e-5;
    EXPECT_NEAR(found.by_column, (value(at + h, at + 0.3) - value(at - h, at + 0.3)) / (2 * h),
                1e-6);
    EXPECT_NEAR(found.by_row, (value(at, at + 0.3 + h) - value(at, at + 0.3 - h)) / (2 * h), 1e-6);
  }
}

TEST(ShiftMask, LosesWhatCameFromOutsideOrFromMaskedTexels) {
  std::vector<float> mask(kSize * kSize, 1.0f);
  mask[8 * kSize + 8] = 0;
  ShiftMask(Uniform(1.5, 0), kSize, kSize, &mask);
  for (int row = 0; row < kSize; ++row) {
    for (int column = 0; column < kSize; ++column) {
      const bool outside = column + 2 >= kSize;
      const bool masked = row == 8 && (column + 1 == 8 || column + 2 == 8 || column == 8);
      EXPECT_EQ(mask[static_cast<size_t>(row * kSize + column)], outside || masked ? 0 : 1)
          << row << ' ' << column;
    }
  }
}

}  // namespace
}  // namespace glint
