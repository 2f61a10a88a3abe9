#include "fitting/reflectance/convention.h"

#include <gtest/gtest.h>

#include <stdexcept>

#include "fitting/reflectance/view.h"

namespace glint {
namespace {

TEST(ConventionTest, TextRoundTripKeepsEverySwitch) {
  for (const auto diffuse : {DiffuseWeight::kOne, DiffuseWeight::kOneMinusSpecular}) {
    for (const auto falloff : {LightFalloff::kNone, LightFalloff::kInverseSquare}) {
      for (const auto sampling : {TexelSampling::kPixelCentres, TexelSampling::kCornerToCorner}) {
        const ReflectanceConvention convention{diffuse, falloff, sampling};
        EXPECT_EQ(ParseReflectanceConvention(ToString(convention)), convention);
      }
    }
  }
}

TEST(ConventionTest, UnknownWordIsNamedInTheError) {
  try {
    ParseReflectanceConvention("diffuse=one light=laser");
    FAIL() << "accepted";
  } catch (const std::invalid_argument& error) {
    EXPECT_NE(std::string(error.what()).find("light=laser"), std::string::npos) << error.what();
  }
  EXPECT_THROW(ParseReflectanceConvention(""), std::invalid_argument);
}

TEST(SamplePlaneTest, RowZeroIsAtPositiveYAndSamplingDecidesTheEnds) {
  SamplePlane plane{4, 2, 40.0, 20.0, TexelSampling::kPixelCentres};
  EXPECT_DOUBLE_EQ(plane.x_mm(0), -15.0);
  EXPECT_DOUBLE_EQ(plane.x_mm(3), 15.0);
  EXPECT_DOUBLE_EQ(plane.y_mm(0), 5.0);
  plane.sampling = TexelSampling::kCornerToCorner;
  EXPECT_DOUBLE_EQ(plane.x_mm(0), -20.0);
  EXPECT_DOUBLE_EQ(plane.y_mm(0), 10.0);
  EXPECT_DOUBLE_EQ(plane.y_mm(1), -10.0);
}

}  // namespace
}  // namespace glint
