#include "datasets/looks/looks.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <opencv2/imgproc.hpp>
#include <stdexcept>

#include "datasets/looks/looks_figures.h"

namespace glint {
namespace {

using Radiance = std::function<double(int x, int y, int channel)>;

RectifiedImage Picture(int width, int height, const Radiance& radiance) {
  const size_t texels = static_cast<size_t>(width) * height;
  RectifiedImage image{width, height, std::vector<float>(3 * texels),
                       std::vector<float>(texels, 1.0f)};
  for (int c = 0; c < 3; ++c) {
    for (int y = 0; y < height; ++y) {
      for (int x = 0; x < width; ++x) {
        image.rgb[c * texels + static_cast<size_t>(y) * width + x] =
            static_cast<float>(radiance(x, y, c));
      }
    }
  }
  return image;
}

RectifiedImage Constant(float value, int width = 64, int height = 48) {
  return Picture(width, height, [value](int, int, int) { return value; });
}

// Fine and coarse waves, and a highlight that clips.
RectifiedImage PhotographOf(int width, int height) {
  return Picture(width, height, [=](int x, int y, int c) {
    const double across = x - 0.6 * width, down = y - 0.4 * height;
    return 0.3 + 0.12 * std::sin(0.9 * x + 0.4 * y) + 0.1 * std::sin(0.21 * x - 0.17 * y + c) +
           1.5 * std::exp(-(across * across + down * down) / 400);
  });
}

// The waves are out of phase, and the highlight is broader, weaker and beside its place.
RectifiedImage Rendering(int width, int height) {
  return Picture(width, height, [=](int x, int y, int c) {
    const double across = x - 0.6 * width - 4, down = y - 0.4 * height - 2;
    return 0.25 + 0.08 * std::sin(0.9 * x + 0.4 * y + 0.3) +
           0.12 * std::sin(0.21 * x - 0.17 * y + c - 0.2) +
           0.45 * std::exp(-(across * across + down * down) / 900);
  });
}

// Of no particular scale: the same for any place, whichever picture asks.
double Grain(int x, int y, int seed) {
  unsigned h = static_cast<unsigned>(x) * 73856093u ^ static_cast<unsigned>(y) * 19349663u ^
               static_cast<unsigned>(seed) * 83492791u;
  h = (h ^ (h >> 13)) * 1274126177u;
  return static_cast<double>((h ^ (h >> 16)) & 0xffff) / 0xffff - 0.5;
}

// Grain on a slow wave, moved to the right and down by `shift` texels.
RectifiedImage Grainy(int side, int shift = 0, int seed = 1) {
  return Picture(side, side, [=](int x, int y, int) {
    const int u = x - shift, v = y - shift;
    return 0.3 + 0.1 * std::sin(0.1 * u) + 0.3 * Grain(u, v, seed);
  });
}

RectifiedImage Blurred(RectifiedImage image, double sigma) {
  for (size_t c = 0; c < 3; ++c) {
    cv::Mat plane(image.height, image.width, CV_32F, image.rgb.data() + c * image.mask.size());
    cv::GaussianBlur(plane, plane, {0, 0}, sigma);
  }
  return image;
}

RectifiedImage Times(RectifiedImage image, float factor) {
  for (float& value : image.rgb) value *= factor;
  return image;
}

Looks Compare(const RectifiedImage& rendered, const RectifiedImage& photograph) {
  return CompareLooks(rendered.rgb, photograph, true);
}

TEST(CompareLooks, OnePictureLooksLikeItself) {
  const Looks looks = Compare(PhotographOf(256, 200), PhotographOf(256, 200));
  EXPECT_EQ(looks.free, 0);
  for (const double contrast : looks.contrast) EXPECT_NEAR(contrast, 1, 1e-12);
  for (const double correlation : looks.correlation) EXPECT_NEAR(correlation, 1, 1e-4);
  EXPECT_NEAR(looks.ssim, 1, 1e-6);
  EXPECT_NEAR(looks.highlight, 1, 1e-12);
}

// The figures are those of a program in Python, by numpy, of the same pictures. 1101 texels are so
// many that the coarsest band is of a halved picture.
TEST(CompareLooks, AgreesWithAnotherProgram) {
  struct Case {
    int width, height;
    std::array<double, 10> figures;
  };
  const Case cases[] = {
      {300, 200, {.1396, .8419, .8719, 1.3853, 1.2732, .9770, .9710, .9839, .9076, .6301}},
      {256, 64, {.1476, .8230, .8388, 1.2576, 1.1782, .9763, .9752, .9457, .8812, .6445}},
      {1101, 200, {.1369, .9061, 1.4119, .7373, .8960, .9529, .9748, .9551, .9154, .7324}}};
  for (const Case& said : cases) {
    const Looks looks =
        Compare(Rendering(said.width, said.height), PhotographOf(said.width, said.height));
    const auto columns = LooksColumns();
    ASSERT_EQ(columns.size(), said.figures.size());
    for (size_t i = 0; i < columns.size(); ++i) {
      EXPECT_NEAR(columns[i].ValueOf(looks), said.figures[i], 0.005)
          << columns[i].key() << " " << said.width;
    }
  }
}

TEST(CompareLooks, TheExposureOfEachChannelIsFree) {
  const RectifiedImage photograph = Grainy(128);
  RectifiedImage rendered = Grainy(128, 0, 2);
  const double free = Compare(rendered, photograph).free;
  EXPECT_GT(free, 0.2);
  rendered = Times(rendered, 0.7f);
  std::for_each(rendered.rgb.begin(), rendered.rgb.begin() + 128 * 128,
                [](float& red) { red *= 1.3f; });
  EXPECT_NEAR(Compare(rendered, photograph).free, free, 0.02);
}

TEST(CompareLooks, BlurLosesFineContrastAndKeepsCoarseDetail) {
  const Looks looks = Compare(Blurred(Grainy(256), 1.5), Grainy(256));
  EXPECT_LT(looks.contrast[0], 0.5);
  EXPECT_LT(looks.contrast[0], looks.contrast[1]);
  EXPECT_LT(looks.contrast[1], looks.contrast[2]);
  EXPECT_GT(looks.contrast[3], 0.7);
  EXPECT_GT(looks.correlation[1], 0.75);
  EXPECT_GT(looks.correlation[2], 0.9);
}

TEST(CompareLooks, DetailThatIsNotThePhotographsHasItsContrastAndNoCorrelation) {
  const Looks looks = Compare(Grainy(256, 0, 2), Grainy(256));
  EXPECT_NEAR(looks.contrast[0], 1, 0.05);
  EXPECT_LT(looks.correlation[0], 0.1);
}

TEST(CompareLooks, AShiftOfTwoTexelsKeepsTheCorrelation) {
  for (const double correlation : Compare(Grainy(256, 2), Grainy(256)).correlation) {
    EXPECT_GT(correlation, 0.99);
  }
  EXPECT_LT(Compare(Grainy(256, 6), Grainy(256)).correlation[0], 0.2);
}

TEST(CompareLooks, ALargePictureIsJudgedAtItsOwnScale) {
  const RectifiedImage small = Grainy(256), blurred = Blurred(small, 1.5);
  const auto enlarged = [](const RectifiedImage& image) {
    return Picture(1024, 1024, [&](int x, int y, int c) {
      const size_t i = static_cast<size_t>(y / 4) * 256 + x / 4;
      return image.rgb[c * image.mask.size() + i];
    });
  };
  const Looks at_256 = Compare(blurred, small);
  const Looks at_1024 = Compare(enlarged(blurred), enlarged(small));
  for (const LooksColumn& column : LooksColumns()) {
    if (column.figure->bands.empty()) continue;
    EXPECT_NEAR(column.ValueOf(at_1024), column.ValueOf(at_256), 0.06) << column.key();
  }
  EXPECT_NEAR(at_1024.free, at_256.free, 1e-6);
}

TEST(CompareLooks, ClippedTexelsDoNotCountInFree) {
  RectifiedImage photograph = Grainy(64), rendered = Grainy(64, 0, 2);
  const auto clip = [&](size_t texels) {
    for (size_t i = 0; i < 3 * texels; ++i) {
      photograph.rgb[i % texels + i / texels * photograph.mask.size()] = 1.2f;
    }
  };
  clip(300);
  const double free = Compare(rendered, photograph).free;
  for (size_t i = 0; i < 300; ++i) rendered.rgb[i] = rendered.rgb[i + 2 * 64 * 64] = 0;
  EXPECT_EQ(Compare(rendered, photograph).free, free);
  clip(64 * 64);
  EXPECT_TRUE(std::isnan(Compare(rendered, photograph).free));
  EXPECT_FALSE(std::isnan(Compare(rendered, photograph).ssim));
}

TEST(CompareLooks, WhatThePhotographDoesNotSayIsNotHeldAgainstTheRendering) {
  RectifiedImage photograph = Grainy(64), rendered = photograph;
  for (size_t i = 0; i < 3 * 64 * 20; ++i) {
    const size_t texel = i % (64 * 20);
    photograph.mask[texel] = 0;
    photograph.rgb[i / (64 * 20) * 64 * 64 + texel] = std::nanf("");
  }
  const Looks looks = Compare(rendered, photograph);
  EXPECT_EQ(looks.free, 0);
  EXPECT_NEAR(looks.contrast[2], 1, 1e-12);
  EXPECT_NEAR(looks.ssim, 1, 1e-6);
  std::fill(photograph.mask.begin(), photograph.mask.end(), 0.0f);
  std::fill(photograph.rgb.begin(), photograph.rgb.end(), 0.0f);
  const Looks unknown = Compare(rendered, photograph);
  for (const LooksColumn& column : LooksColumns()) {
    EXPECT_TRUE(std::isnan(column.ValueOf(unknown))) << column.key();
  }
}

// Rectification masks texels that a clipped pixel had a part in; they are bright.
TEST(CompareLooks, WhatIsMaskedForBeingClippedCounts) {
  RectifiedImage photograph = Constant(0.5f), rendered = Constant(0.5f);
  for (size_t i = 0; i < 500; ++i) {
    photograph.mask[i] = 0;
    rendered.rgb[i] = 0.2f;
  }
  EXPECT_GT(CompareLooks(rendered.rgb, photograph, true).free, 0);
  EXPECT_EQ(CompareLooks(rendered.rgb, photograph, false).free, 0);  // it does not clip
}

TEST(CompareLooks, PicturesOfAnySizeAndShapeHaveFigures) {
  for (const auto& [width, height] :
       {std::pair{1, 1}, {2, 7}, {8, 8}, {16, 16}, {24, 33}, {16, 300}, {301, 18}, {700, 3}}) {
    const auto grain = [](int seed) {
      return [seed](int x, int y, int) { return 0.3 + 0.3 * Grain(x, y, seed); };
    };
    const Looks looks = Compare(Picture(width, height, grain(1)), Picture(width, height, grain(2)));
    EXPECT_GE(looks.free, 0) << width;
    EXPECT_GE(looks.ssim, -1) << width;
    EXPECT_LE(looks.ssim, 1 + 1e-6) << width;
    EXPECT_GT(looks.highlight, 0) << width;
    for (const double contrast : looks.contrast) EXPECT_FALSE(contrast < 0) << width;
    for (const double correlation : looks.correlation) {
      const double side = std::min(width, height) * std::min(1.0, 256.0 / width);
      EXPECT_EQ(std::isnan(correlation), side < 15.5) << width << " " << height;
      EXPECT_FALSE(std::abs(correlation) > 1) << width;
    }
  }
}

TEST(CompareLooks, WithoutDetailThereIsNothingToCompareItWith) {
  const Looks flat = Compare(Grainy(64), Constant(0.3f, 64, 64));
  for (const double contrast : flat.contrast) EXPECT_TRUE(std::isnan(contrast));
  for (const double correlation : flat.correlation) EXPECT_TRUE(std::isnan(correlation));
  const Looks lost = Compare(Constant(0.3f, 64, 64), Grainy(64));
  for (const double contrast : lost.contrast) EXPECT_NEAR(contrast, 0, 1e-3);
  for (const double correlation : lost.correlation) EXPECT_NEAR(correlation, 0, 1e-3);
  EXPECT_TRUE(std::isnan(Compare(Grainy(64), Constant(0, 64, 64)).highlight));
}

TEST(CompareLooks, SizesMustAgree) {
  EXPECT_THROW(Compare(Constant(1, 2, 2), Constant(1)), std::invalid_argument);
}

}  // namespace
}  // namespace glint
