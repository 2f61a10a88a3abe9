#include "fitting/estimator/photograph_features.h"

#include <gtest/gtest.h>

#include <cmath>

#include "fitting/estimator/photograph_features_torch.h"
#include "tests/fitting/initial_maps/synthetic_set.h"

namespace glint {
namespace {

using test::PhotographMaps;
using test::UniformMaps;

float Plane(const PhotographFeatures& f, int plane, int row, int column) {
  const size_t texels = static_cast<size_t>(f.width) * f.height;
  return f.planes[plane * texels + static_cast<size_t>(row) * f.width + column];
}

float OfRing(const PhotographFeatures& f, int bin, int value) {
  return f.profile[static_cast<size_t>(6 * bin + value)];
}

TEST(PhotographFeatures, ShowTheRootOfAMatteAlbedoWhateverLightAndView) {
  const SvbrdfMaps truth = UniformMaps(24, 0.36f, 0.0f, 1.0f);
  for (const double power : {0.5, 2.0}) {
    const PhotographSet set = PhotographMaps(truth, 3, false, power);
    for (const Photograph& photo : set.photographs) {
      const PhotographFeatures f = FeaturesOf(photo, set.plane, set.convention);
      // F0 = 0 still reflects a little at grazing angles and r = 1: 2 % of the root.
      EXPECT_NEAR(Plane(f, 0, 12, 3), 0.6f, 0.015f);
      EXPECT_EQ(Plane(f, 3, 12, 3), 0.0f);
      EXPECT_EQ(Plane(f, 4, 12, 3), 1.0f);
    }
  }
}

TEST(PhotographFeatures, ProfileRisesTowardAPolishedSamplesHighlight) {
  const PhotographSet polished = PhotographMaps(UniformMaps(64, 0.1f, 0.05f, 0.2f), 1, false);
  const PhotographSet matte = PhotographMaps(UniformMaps(64, 0.1f, 0.05f, 0.9f), 1, false);
  const auto rise = [](const PhotographSet& set) {
    const PhotographFeatures f = FeaturesOf(set.photographs[0], set.plane, set.convention);
    return OfRing(f, 1, 1) - OfRing(f, 8, 1);
  };
  EXPECT_GT(rise(polished), 1.0f);
  EXPECT_LT(rise(matte), 0.3f);
}

// Rectification masks what clipped; without it a highlight's middle would look like a hole.
TEST(PhotographFeatures, WhatIsMaskedForClippingIsPartOfTheHighlight) {
  PhotographSet set = PhotographMaps(UniformMaps(16, 0.3f, 0.04f, 0.5f), 1);
  Photograph& photo = set.photographs[0];
  const auto paint = [&](size_t texel, float radiance) {
    photo.mask[texel] = 0;
    for (size_t c = 0; c < 3; ++c) photo.rgb[c * 256 + texel] = radiance;
  };
  paint(0, 0.9f);
  paint(1, 0.1f);
  const PhotographFeatures f = FeaturesOf(photo, set.plane, set.convention);
  EXPECT_GT(Plane(f, 0, 0, 0), 0.5f);
  EXPECT_EQ(Plane(f, 3, 0, 0), 1.0f);
  EXPECT_EQ(Plane(f, 4, 0, 0), 1.0f);
  EXPECT_EQ(Plane(f, 0, 0, 1), 0.0f);
  EXPECT_EQ(Plane(f, 4, 0, 1), 0.0f);
  photo.ldr = false;  // a float photograph does not clip: the texel is masked for something else
  EXPECT_EQ(Plane(FeaturesOf(photo, set.plane, set.convention), 4, 0, 0), 0.0f);
}

TEST(PhotographFeatures, MaskedTexelsSayNothing) {
  PhotographSet set = PhotographMaps(UniformMaps(16, 0.3f, 0.04f, 0.5f), 1);
  const PhotographFeatures before = FeaturesOf(set.photographs[0], set.plane, set.convention);
  for (int i = 0; i < 40; ++i) {
    set.photographs[0].mask[i] = 0;
    for (int c = 0; c < 3; ++c) set.photographs[0].rgb[c * 256 + i] = std::nanf("");
  }
  const PhotographFeatures after = FeaturesOf(set.photographs[0], set.plane, set.convention);
  EXPECT_EQ(Plane(after, 0, 0, 0), 0.0f);
  EXPECT_EQ(Plane(after, 4, 0, 0), 0.0f);
  for (const float x : after.planes) EXPECT_TRUE(std::isfinite(x));
  for (const float x : after.profile) EXPECT_TRUE(std::isfinite(x));
  EXPECT_EQ(Plane(before, 0, 15, 15), Plane(after, 0, 15, 15));
}

// Training makes them for batches, fitting for one photograph after the other.
TEST(PhotographFeatures, AreTheSameForBatches) {
  for (const bool ldr : {true, false}) {
    PhotographSet set = PhotographMaps(UniformMaps(40, 0.3f, 0.2f, 0.2f), 3, ldr, 1.5);
    ViewBatch batch{set.plane, set.convention, 3, {}};
    std::vector<torch::Tensor> radiance, mask;
    for (Photograph& photo : set.photographs) {
      for (size_t i = 0; i < 300; ++i) {
        photo.mask[i] = 0;
        for (size_t c = 0; c < 3; ++c) photo.rgb[c * 1600 + i] = 0;
      }
      photo.ldr = ldr;
      batch.views.push_back(photo.view);
      radiance.push_back(torch::from_blob(photo.rgb.data(), {3, 40, 40}).clone());
      mask.push_back(torch::from_blob(photo.mask.data(), {1, 40, 40}).clone());
    }
    const auto stacked = [](const std::vector<torch::Tensor>& list) {
      return torch::stack(list).unsqueeze(0);
    };
    const FeatureTensors all = FeaturesOfTensors(
        {stacked(radiance), stacked(mask), torch::full({1, 3, 1, 1, 1}, ldr ? 1.0f : 0.0f)},
        TensorsOf(batch, torch::kFloat32), batch.plane, batch.convention.falloff);
    for (int n = 0; n < 3; ++n) {
      const PhotographFeatures one =
          FeaturesOf(set.photographs[static_cast<size_t>(n)], set.plane, set.convention);
      const torch::Tensor planes = all.planes[0][n].contiguous();
      ASSERT_EQ(static_cast<size_t>(planes.numel()), one.planes.size());
      for (size_t i = 0; i < one.planes.size(); ++i) {
        ASSERT_NEAR(planes.data_ptr<float>()[i], one.planes[i], 2e-5f) << n << " " << i;
      }
      const torch::Tensor profile = all.profiles[0][n].contiguous();
      for (size_t i = 0; i < one.profile.size(); ++i) {
        // A texel at a ring's border may be counted to its neighbour.
        ASSERT_NEAR(profile.data_ptr<float>()[i], one.profile[i], 0.02f) << n << " " << i;
      }
    }
  }
}

TEST(PhotographFeatures, ClippingIsForLdrPhotographsOnly) {
  PhotographSet set = PhotographMaps(UniformMaps(32, 0.9f, 0.5f, 0.2f), 1);
  EXPECT_EQ(Plane(FeaturesOf(set.photographs[0], set.plane, set.convention), 3, 16, 16), 1.0f);
  set.photographs[0].ldr = false;
  EXPECT_EQ(Plane(FeaturesOf(set.photographs[0], set.plane, set.convention), 3, 16, 16), 0.0f);
}

}  // namespace
}  // namespace glint
