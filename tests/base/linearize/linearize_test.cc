#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "base/errors/errors.h"
#include "base/linearize/encoding.h"
#include "base/linearize/light_guess.h"
#include "base/linearize/linear_photo.h"

namespace glint {
namespace {

TEST(Encoding, CurvesAndTheirInversesMeet) {
  for (const Encoding encoding : {Encoding::kLinear, Encoding::kSrgb, Encoding::kGamma22}) {
    for (int i = 0; i <= 1000; ++i) {
      const float value = static_cast<float>(i) / 1000;
      EXPECT_NEAR(EncodedFromLinear(encoding, LinearFromEncoded(encoding, value)), value, 1e-6);
    }
    EXPECT_EQ(LinearFromEncoded(encoding, 0), 0);
    EXPECT_EQ(LinearFromEncoded(encoding, 1), 1);
    EXPECT_EQ(LinearFromEncoded(encoding, -0.5f), 0);
  }
}

TEST(Encoding, KnowsPublishedValues) {
  EXPECT_NEAR(LinearFromEncoded(Encoding::kSrgb, 0.5f), 0.21404114, 1e-6);
  EXPECT_NEAR(LinearFromEncoded(Encoding::kSrgb, 0.04045f), 0.0031308, 1e-6);
  EXPECT_NEAR(LinearFromEncoded(Encoding::kGamma22, 0.5f), 0.21763764, 1e-6);
}

TEST(Encoding, MeasuredCurvesAreReadPerChannelAndForDevelopedPhotosAlone) {
  ResponseCurve curve;
  for (int c = 0; c < 3; ++c) {
    for (int i = 0; i < 256; ++i) {
      curve.linear[c].push_back(std::pow(static_cast<float>(i) / 255, 1.5f + c));
    }
  }
  const std::string file = ::testing::TempDir() + "/response.json";
  WriteResponseCurve(file, curve);
  const Encoding encoding = ResolveEncoding(file, "a.jpg", 8);
  ASSERT_EQ(encoding.kind(), Encoding::kResponse);
  EXPECT_EQ(ResolveEncoding(file, "a.dng", 16), Encoding::kLinear);
  EXPECT_EQ(ResolveEncoding(file, "a.exr", 32), Encoding::kLinear);
  for (const int bits : {8, 16}) {
    Photo photo;
    photo.bits = bits;
    Image grey(16, 16, {"R", "G", "B"});
    std::fill(grey.samples.begin(), grey.samples.end(), 102 / 255.0f);
    photo.image = Stored(grey, bits);
    const auto pixel =
        LinearPhoto(photo, encoding).Visit([](const auto& reader) { return reader.At(5); });
    for (int c = 0; c < 3; ++c) {
      EXPECT_NEAR(pixel.rgb[c], std::pow(0.4f, 1.5f + c), 1e-5) << bits << " " << c;
      EXPECT_NEAR(EncodedFromLinear(encoding, pixel.rgb[c], c), 0.4f, 1e-5);
    }
  }
  std::swap(curve.linear[1][100], curve.linear[1][101]);
  WriteResponseCurve(file, curve);
  EXPECT_THROW(ResolveEncoding(file, "a.jpg", 8), UserError);  // it falls
}

// Encoding the table's value gives the code back, for every code of 8 and 16 bits.
TEST(Encoding, TablesRoundTripEveryCode) {
  for (const Encoding encoding : {Encoding::kLinear, Encoding::kSrgb, Encoding::kGamma22}) {
    for (const int codes : {256, 65536}) {
      const std::vector<float> table = LinearTable(encoding, codes);
      for (int code = 0; code < codes; ++code) {
        const float encoded = EncodedFromLinear(encoding, table[static_cast<size_t>(code)]);
        ASSERT_EQ(std::lround(encoded * static_cast<float>(codes - 1)), code);
      }
    }
  }
}

TEST(Encoding, AutoFollowsWhatTheFileIs) {
  EXPECT_EQ(ResolveEncoding("auto", "a.jpg", 8), Encoding::kGamma22);
  EXPECT_EQ(ResolveEncoding("auto", "a.tif", 16), Encoding::kGamma22);
  EXPECT_EQ(ResolveEncoding("auto", "a.exr", 32), Encoding::kLinear);
  EXPECT_EQ(ResolveEncoding("auto", "a.DNG", 16), Encoding::kLinear);
  EXPECT_EQ(ResolveEncoding("srgb", "a.exr", 32), Encoding::kSrgb);
  EXPECT_EQ(ResolveEncoding("none", "a.jpg", 8), Encoding::kLinear);
  EXPECT_THROW(ResolveEncoding("log", "a.jpg", 8), UserError);
}

TEST(Encoding, AutoTakesTheProfilesCurveWhereItIsNotSrgbs) {
  Photo photo;
  EXPECT_EQ(ResolveEncoding("auto", "a.jpg", photo), Encoding::kGamma22);
  photo.colour = AdobeRgbProfile();
  const Encoding encoding = ResolveEncoding("auto", "a.jpg", photo);
  EXPECT_NEAR(LinearFromEncoded(encoding, 0.5f), std::pow(0.5, 563.0 / 256), 1e-4);
  EXPECT_EQ(ResolveEncoding("srgb", "a.jpg", photo), Encoding::kSrgb);
  EXPECT_EQ(ResolveEncoding("auto", "a.dng", photo), Encoding::kLinear);
}

TEST(LinearPhoto, IsInRec709WhateverTheProfile) {
  for (const int bits : {8, 16, 32}) {
    Photo photo;
    photo.bits = bits;
    Image pixel(1, 1, {"R", "G", "B"});
    pixel.samples = {0.8f, 0.2f, 0.0f};
    photo.image = Stored(pixel, bits);
    photo.colour = ProfileOfCodePoints(12, 13);
    const LinearPhoto linear(photo, Encoding::kLinear);
    const auto rgb = linear.Visit([](const auto& reader) { return reader.At(0).rgb; });
    EXPECT_NEAR(rgb[0], 1.2249 * 0.8 - 0.2247 * 0.2, 3e-3) << bits;
    EXPECT_NEAR(rgb[1], -0.0420 * 0.8 + 1.0419 * 0.2, 3e-3) << bits;
    EXPECT_LT(rgb[2], 0) << bits;  // beyond Rec.709, and kept
  }
}

TEST(LinearPhoto, ReadsStoredCodesThroughTheCurve) {
  for (const int bits : {8, 16, 32}) {
    Photo photo;
    photo.bits = bits;
    Image pixels(2, 1, {"R", "G", "B"});
    pixels.samples = {10 / 255.0f, 254 / 255.0f, 20 / 255.0f, 30 / 255.0f, 40 / 255.0f, 0.0f};
    photo.image = Stored(pixels, bits);
    SaturationRule rule;
    rule.float_level = 0.995;
    const LinearPhoto linear(photo, Encoding::kSrgb, rule);
    const auto [first, second] =
        linear.Visit([](const auto& reader) { return std::pair(reader.At(0), reader.At(1)); });
    EXPECT_NEAR(first.rgb[0], LinearFromEncoded(Encoding::kSrgb, 10 / 255.0f), 1e-5);
    EXPECT_NEAR(first.rgb[2], LinearFromEncoded(Encoding::kSrgb, 40 / 255.0f), 1e-5);
    EXPECT_FALSE(first.saturated);
    EXPECT_TRUE(second.saturated);
  }
}

// A Lambertian sample of albedo 0.3 under a known light: the guess finds the light.
TEST(LightGuess, FindsTheLightOfASampleOfMiddlingAlbedo) {
  SamplePlane plane;
  plane.width = 100;
  plane.height = 60;
  plane.width_mm = 100;
  plane.height_mm = 60;
  const double power = 5e4;
  for (const LightFalloff falloff : {LightFalloff::kInverseSquare, LightFalloff::kNone}) {
    LightGuess guess(plane, falloff);
    std::vector<View> views;
    for (const double x : {-40.0, 0.0, 70.0}) {
      View view;
      view.light_in_sample_mm = {x, 20, 200};
      view.exposure = 1 + x / 200;
      RectifiedImage image{plane.width, plane.height, std::vector<float>(3 * 6000),
                           std::vector<float>(6000, 1.0f)};
      for (int row = 0; row < plane.height; ++row) {
        for (int column = 0; column < plane.width; ++column) {
          const double dx = x - plane.x_mm(column), dy = 20 - plane.y_mm(row);
          const double d = std::sqrt(dx * dx + dy * dy + 200 * 200);
          double value = power * 0.3 / std::numbers::pi * 200 / d * view.exposure;
          if (falloff == LightFalloff::kInverseSquare) value /= d * d;
          if (x == 0 && column < 70) value *= 20;  // a highlight, in one view only
          for (size_t c = 0; c < 3; ++c) {
            image.rgb[c * 6000 + static_cast<size_t>(row) * 100 + column] =
                static_cast<float>(value);
          }
        }
      }
      guess.Add(image);
      views.push_back(view);
    }
    EXPECT_NEAR(guess.Power(views), power, 1e-3 * power);
  }
}

TEST(LightGuess, KeepsBrightTexelsBelowOne) {
  SamplePlane plane;
  plane.width = plane.height = 10;
  plane.width_mm = plane.height_mm = 1e-3;
  LightGuess guess(plane, LightFalloff::kNone);
  RectifiedImage image{10, 10, std::vector<float>(300, 0.01f), std::vector<float>(100, 1.0f)};
  for (size_t i = 0; i < 300; i += 5) image.rgb[i] = 1.0f;
  guess.Add(image);
  View view;
  view.light_in_sample_mm = {0, 0, 100};
  EXPECT_NEAR(std::numbers::pi / guess.Power({view}), 0.95, 1e-3);
}

TEST(LightGuess, SaysNothingOfNothing) {
  SamplePlane plane;
  plane.width = plane.height = 4;
  LightGuess guess(plane, LightFalloff::kNone);
  guess.Add({4, 4, std::vector<float>(48, 0.5f), std::vector<float>(16, 0.0f)});
  EXPECT_EQ(guess.Power({View{}}), 0);
}

}  // namespace
}  // namespace glint
