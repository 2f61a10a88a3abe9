#include "fitting/texel/texel_parameters.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/reflectance/svbrdf_maps.h"

namespace glint {
namespace {

TEST(TexelParameters, ValuesStayInsideTheirBoundsAndComeBack) {
  for (int i = -500; i < 500; ++i) {
    const double u = 0.01 * i;
    double derivative;
    const double value = BoundedValue(kRoughnessBounds, u, &derivative);
    EXPECT_GE(value, kRoughnessBounds.low);
    EXPECT_LE(value, kRoughnessBounds.high);
    EXPECT_GT(derivative, 0.0);
    if (value > kRoughnessBounds.low + 0.01 && value < kRoughnessBounds.high - 0.01) {
      EXPECT_NEAR(UnboundedVariable(kRoughnessBounds, value), u, 1e-9);
    }
  }
}

TEST(TexelParameters, NormalsOf80DegreesSurviveAReadingAndWriting) {
  SvbrdfMaps maps(1, 1);
  const float tilt = 80.0f * 3.14159265f / 180.0f;
  maps.at(kNormalX, 0, 0) = std::sin(tilt);
  maps.at(kNormalZ, 0, 0) = std::cos(tilt);
  maps.at(kRoughness, 0, 0) = 0.5f;
  SvbrdfMaps back(1, 1);
  WriteTexel(ReadTexel(maps, 0), 0, &back);
  EXPECT_NEAR(back.at(kNormalX, 0, 0), maps.at(kNormalX, 0, 0), 1e-6);
  EXPECT_NEAR(back.at(kNormalZ, 0, 0), maps.at(kNormalZ, 0, 0), 1e-6);
}

}  // namespace
}  // namespace glint
