#include "base/colour/srgb.h"

#include <gtest/gtest.h>

namespace glint {
namespace {

TEST(Srgb, EncodesAsTheStandardSays) {
  EXPECT_NEAR(SrgbFromLinear(0.21404114), 0.5, 1e-7);
  EXPECT_NEAR(SrgbFromLinear(0.001), 0.01292, 1e-9);
  EXPECT_NEAR(SrgbFromLinear(1.0), 1.0, 1e-12);
}

TEST(Srgb, DecodingUndoesEncoding) {
  for (int i = 0; i <= 1000; ++i) {
    EXPECT_NEAR(LinearFromSrgb(SrgbFromLinear(i / 1000.0)), i / 1000.0, 1e-7);
    EXPECT_NEAR(LinearFromSrgb(SrgbFromLinear(i / 1000.0f)), i / 1000.0f, 1e-6f);
  }
}

TEST(Srgb, PicturesEndAtBlackAndWhite) {
  EXPECT_EQ(ClampedSrgb(-1.0f), 0.0f);
  EXPECT_NEAR(ClampedSrgb(2.0f), 1.0f, 1e-6f);
}

}  // namespace
}  // namespace glint
