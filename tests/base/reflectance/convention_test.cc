#include "base/reflectance/convention.h"

#include <gtest/gtest.h>

#include <stdexcept>

#include "base/reflectance/view.h"

namespace glint {
namespace {

TEST(ConventionTest, TextRoundTripKeepsEverySwitch) {
  for (const auto diffuse : {DiffuseWeight::kOne, DiffuseWeight::kOneMinusSpecular}) {
    for (const auto falloff : {LightFalloff::kNone, LightFalloff::kInverseSquare}) {
      for (const auto sampling : {TexelSampling::kPixelCentres, TexelSampling::kCornerToCorner}) {
        for (const SpecularLobes& lobes :
             {SpecularLobes(), SpecularLobes{0.85, 0.25}, SpecularLobes{0.3, 0.4, 0.04},
              SpecularLobes{.tail_exponent = 4}, SpecularLobes{0.3, 0.4, 0.04, 8},
              SpecularLobes{.anisotropy = {1.5, 90}}, SpecularLobes{0.3, 0.4, 0, 4, {2.25, 0}}}) {
          const ReflectanceConvention convention{diffuse, falloff, sampling, lobes};
          EXPECT_EQ(ParseReflectanceConvention(ToString(convention)), convention);
        }
      }
    }
  }
}

TEST(ConventionTest, OneLobeIsNotWritten) {
  EXPECT_EQ(ToString(ReflectanceConvention()),
            "diffuse=one light=inverse_square sampling=pixel_centres");
}

TEST(ConventionTest, RefusesLobesThatAreNone) {
  for (const char* text : {"", "0.5", "x0.4", "0.5x", "0.5x0.4x", "1x0.4", "-0.1x0.4", "0.5x0",
                           "0.5x1.1", "nanx0.4", "0.5xnan", "0.5x0.4@", "0.5x0.4@0", "0.5x0.4@1.1",
                           "0.5x0.4@-1", "0.5x0.4@nan", "0.5x0.4@0.04x"}) {
    EXPECT_THROW(ParseReflectanceConvention(std::string("narrow_lobe=") + text),
                 std::invalid_argument)
        << text;
  }
}

TEST(ConventionTest, RefusesTailsThatAreNone) {
  for (const char* text : {"", "1", "2.5", "33", "-4", "4x", "nan"}) {
    EXPECT_THROW(ParseReflectanceConvention(std::string("tail=") + text), std::invalid_argument)
        << text;
  }
}

TEST(ConventionTest, RefusesAnisotropyThatIsNone) {
  for (const char* text : {"", "1.5", "@90", "1.5@", "1.5@90x", "0.9@90", "101@0", "1.5@180",
                           "1.5@-1", "nan@0", "1.5@nan"}) {
    EXPECT_THROW(ParseReflectanceConvention(std::string("anisotropy=") + text),
                 std::invalid_argument)
        << text;
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
