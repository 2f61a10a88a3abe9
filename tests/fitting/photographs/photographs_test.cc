#include "fitting/photographs/photographs.h"

#include <gtest/gtest.h>

#include <limits>
#include <numeric>
#include <vector>

#include "tests/fitting/initial_maps/synthetic_set.h"
#include "tests/training/toy_materials.h"

namespace glint {
namespace {

using test::PhotographMaps;

TEST(Downsampled, KeepsMeansAndIgnoresMaskedTexels) {
  PhotographSet set = PhotographMaps(ToyMaterial(2, 30, 20), 1);
  set.environment.radiance_rgb = {{0.1, 0.2, 0.3}};
  const PhotographSet small = Downsampled(set, 15, 10, 1);
  EXPECT_EQ(small.environment.radiance_rgb, set.environment.radiance_rgb);
  const auto mean = [](const std::vector<float>& v) {
    return std::accumulate(v.begin(), v.end(), 0.0) / static_cast<double>(v.size());
  };
  EXPECT_NEAR(mean(small.photographs[0].rgb), mean(set.photographs[0].rgb), 1e-6);
  EXPECT_EQ(small.photographs[0].rgb, Downsampled(set, 15, 10, 2).photographs[0].rgb);
  set.photographs[0].mask[0] = 0;
  set.photographs[0].rgb[0] = std::numeric_limits<float>::quiet_NaN();
  const PhotographSet holed = Downsampled(set, 15, 10, 1);
  EXPECT_TRUE(std::isfinite(holed.photographs[0].rgb[0]));
  EXPECT_FLOAT_EQ(holed.photographs[0].mask[0], 0.75f);
  EXPECT_THROW(Downsampled(set, 31, 20, 1), std::invalid_argument);
}

// Four texels of a photograph as rectification leaves them, which are averaged to one.
struct Quarter {
  std::vector<float> radiance, mask;
};

Photograph AverageOf(const Quarter& quarter, bool ldr = true) {
  PhotographSet set;
  set.plane = {2, 2, 2, 2, TexelSampling::kPixelCentres};
  Photograph photo;
  photo.ldr = ldr;
  photo.mask = quarter.mask;
  for (int c = 0; c < 3; ++c) {
    photo.rgb.insert(photo.rgb.end(), quarter.radiance.begin(), quarter.radiance.end());
  }
  set.photographs.push_back(photo);
  return Downsampled(set, 1, 1, 1).photographs[0];
}

TEST(Downsampled, WhatIsClippedThroughoutStaysUsableAndAtTheLimit) {
  const Photograph photo = AverageOf({{1, 1, 1, 1}, {1, 1, 1, 1}});
  EXPECT_FLOAT_EQ(photo.rgb[1], 1);
  EXPECT_FLOAT_EQ(photo.mask[0], 1);
  EXPECT_TRUE(ReachesLimit(photo, 0));
}

// As where the photograph is rectified at the smaller size: masked, and bright.
TEST(Downsampled, WhatIsClippedInPartIsMaskedAndKeepsItsRadiance) {
  for (const Quarter& quarter : {Quarter{{0.9f, 0.5f, 0.5f, 0.5f}, {0, 1, 1, 1}},
                                 Quarter{{0.9f, 0.5f, 0.5f, 0.5f}, {0, 0, 0, 0}},
                                 Quarter{{1, 0.4f, 0.5f, 0.5f}, {1, 1, 1, 1}}}) {
    const Photograph photo = AverageOf(quarter);
    EXPECT_NEAR(photo.rgb[1], 0.6f, 1e-6f);
    EXPECT_FLOAT_EQ(photo.mask[0], 0);
    EXPECT_TRUE(ReachesLimit(photo, 0));
  }
}

TEST(Downsampled, WhatLiesOutsideOfThePictureIsNoHighlight) {
  const Photograph whole = AverageOf({{0, 0, 0, 0}, {0, 0, 0, 0}});
  EXPECT_FALSE(ReachesLimit(whole, 0));
  EXPECT_FLOAT_EQ(whole.mask[0], 0);
  const Photograph half = AverageOf({{0, 0, 0.5f, 0.5f}, {0, 0, 1, 1}});
  EXPECT_FLOAT_EQ(half.rgb[1], 0.5f);
  EXPECT_FLOAT_EQ(half.mask[0], 0.5f);
  EXPECT_FALSE(ReachesLimit(half, 0));
}

TEST(Downsampled, FloatPhotographsHaveNoLimit) {
  const Photograph photo = AverageOf({{8, 8, 2, 2}, {1, 1, 1, 1}}, false);
  EXPECT_FLOAT_EQ(photo.rgb[1], 5);
  EXPECT_FLOAT_EQ(photo.mask[0], 1);
}

}  // namespace
}  // namespace glint
