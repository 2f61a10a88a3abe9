#include "base/reflectance/characteristic_curve.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace glint {
namespace {

const std::vector<double> kToes = {-0.02, -1e-9, 0, 1e-9, 0.004, 0.05};
const std::vector<double> kShoulders = {-0.3, -1e-9, 0, 1e-9, 0.2, 0.6};

TEST(CharacteristicCurve, AStraightOneChangesNoBit) {
  std::vector<float> radiances = {0, 1e-30f, 0.1234567f, 1, 7.5f};
  const std::vector<float> before = radiances;
  Record({}, radiances);
  EXPECT_EQ(radiances, before);
}

TEST(CharacteristicCurve, BrighterIsRecordedBrighter) {
  for (const double toe : kToes) {
    for (const double shoulder : kShoulders) {
      double last = Recorded(0.0, toe, shoulder).value;
      EXPECT_EQ(last, toe < 0
                          ? -toe * (1 + std::min(shoulder, 0.0)) * (shoulder > 0 ? 1 + shoulder : 1)
                          : 0);
      for (int step = 0; step < 145; ++step) {
        const double radiance = 1e-6 * std::pow(1.1, step);
        const double recorded = Recorded(radiance, toe, shoulder).value;
        ASSERT_GT(recorded, last) << toe << ' ' << shoulder << ' ' << radiance;
        last = recorded;
      }
    }
  }
}

TEST(CharacteristicCurve, SlopesAreDerivatives) {
  for (const double toe : kToes) {
    for (const double shoulder : kShoulders) {
      for (const double radiance : {0.001, 0.02, 0.3, 0.99}) {
        const double step = 1e-6 * radiance;
        const double above = Recorded(radiance + step, toe, shoulder).value;
        const double below = Recorded(radiance - step, toe, shoulder).value;
        ASSERT_NEAR(Recorded(radiance, toe, shoulder).slope, (above - below) / (2 * step), 1e-6)
            << toe << ' ' << shoulder << ' ' << radiance;
      }
    }
  }
}

// What estimation takes steps along.
TEST(CharacteristicCurve, IsSmoothWhereItIsStraight) {
  constexpr double kStep = 1e-7;
  for (const double radiance : {0.02, 0.3, 0.99}) {
    const auto by_toe = [&](double toe) { return Recorded(radiance, toe, 0.0).value - radiance; };
    EXPECT_NEAR(by_toe(kStep) / kStep, -1, 1e-4);
    EXPECT_NEAR(by_toe(-kStep) / -kStep, -1, 1e-4);
    const auto by_shoulder = [&](double shoulder) {
      return Recorded(radiance, 0.0, shoulder).value - radiance;
    };
    const double expected = radiance * (1 - radiance);
    EXPECT_NEAR(by_shoulder(kStep) / kStep, expected, 1e-4);
    EXPECT_NEAR(by_shoulder(-kStep) / -kStep, expected, 1e-4);
  }
}

// A phone's curve: of a tenth of the light less, of the brightest as much.
TEST(CharacteristicCurve, AToeDarkensAndAShoulderPressesTheBrightTogether) {
  EXPECT_NEAR(Recorded(0.5, 0.01, 0.0).value, 0.49, 3e-4);
  EXPECT_LT(Recorded(0.005, 0.01, 0.0).value, 0.4 * 0.005);
  EXPECT_EQ(Recorded(1.0, 0.0, 0.3).value, 1);
  EXPECT_LT(Recorded(1.0, 0.0, 0.3).slope, 0.8);
}

}  // namespace
}  // namespace glint
