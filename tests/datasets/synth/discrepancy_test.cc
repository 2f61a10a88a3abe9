#include "datasets/synth/discrepancy.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "datasets/procedural/material.h"
#include "datasets/synth/view_set.h"
#include "fitting/render/renderer.h"

namespace glint {
namespace {

constexpr int kSize = 32;

class DiscrepancyTest : public testing::Test {
 protected:
  DiscrepancyTest() {
    discrepancy_.strength = 1;
    discrepancy_.relief = false;
    discrepancy_.diffuse_blur_mm = 0;
    view_.camera_in_sample_mm = {10, 5, 200};
    view_.light_in_sample_mm = {22, 5, 200};
    view_.light_rgb = {1e5, 1e5, 1e5};
  }
  std::vector<float> Discrepant() const {
    return RenderDiscrepant(discrepancy_, drawn_, maps_, IntegrateNormals(maps_, plane_), plane_,
                            view_, convention_, 1);
  }
  std::vector<float> Exact() const {
    std::vector<float> rgb(3 * maps_.texels());
    RenderView(maps_, plane_, view_, convention_, rgb.data());
    return rgb;
  }
  static double Difference(const std::vector<float>& a, const std::vector<float>& b) {
    double most = 0;
    for (size_t k = 0; k < a.size(); ++k) most = std::max<double>(most, std::abs(a[k] - b[k]));
    return most;
  }

  Discrepancy discrepancy_;
  DrawnDiscrepancy drawn_;
  SvbrdfMaps maps_ = MakeMaterial(77, kSize, kSize);
  SamplePlane plane_{kSize, kSize, 100, 100, TexelSampling::kPixelCentres};
  ReflectanceConvention convention_ = ReflectanceConvention::Photograph();
  View view_;
};

TEST_F(DiscrepancyTest, LobesAreOtherOnesWhereThereIsSpecular) {
  for (const DiscrepantLobe lobe : {DiscrepantLobe::kSecondLobe, DiscrepantLobe::kAnisotropic}) {
    drawn_.lobe = lobe;
    maps_ = MakeMaterial(77, kSize, kSize);
    EXPECT_GT(Difference(Discrepant(), Exact()), 1e-3);
  }
}

TEST_F(DiscrepancyTest, AnAnisotropicLobeIsWiderAlongItsDirection) {
  for (float& v : maps_.planes) v = 0;
  for (float& z : maps_.plane(kNormalZ)) z = 1;
  for (float& r : maps_.plane(kRoughness)) r = 0.35f;
  for (int c = 0; c < 3; ++c) {
    for (float& s : maps_.plane(kSpecularR + c)) s = 0.05f;
  }
  view_.camera_in_sample_mm = view_.light_in_sample_mm = {0, 0, 150};
  drawn_.lobe = DiscrepantLobe::kAnisotropic;
  drawn_.azimuth_rad = 0;  // along x
  const std::vector<float> rgb = Discrepant();
  const size_t middle = kSize / 2, right = middle * kSize + kSize - 4;
  const size_t below = (kSize - 4) * kSize + middle;
  EXPECT_GT(rgb[right], 1.3 * rgb[below]);
}

TEST_F(DiscrepancyTest, BlurKeepsTheLight) {
  for (int c = 0; c < 3; ++c) {
    for (float& s : maps_.plane(kSpecularR + c)) s = 0;
  }
  drawn_.lobe = DiscrepantLobe::kAnisotropic;
  discrepancy_.anisotropy = 0;
  const std::vector<float> sharp = Discrepant();
  discrepancy_.diffuse_blur_mm = 6;
  const std::vector<float> blurred = Discrepant();
  const auto sum = [](const std::vector<float>& rgb) {
    return std::accumulate(rgb.begin(), rgb.end(), 0.0);
  };
  EXPECT_NEAR(sum(blurred), sum(sharp), 0.02 * sum(sharp));
  const auto contrast = [](const std::vector<float>& rgb) {
    double squares = 0;
    for (size_t k = 1; k < kSize * kSize; ++k) squares += std::pow(rgb[k] - rgb[k - 1], 2);
    return squares;
  };
  EXPECT_LT(contrast(blurred), 0.7 * contrast(sharp));
}

TEST_F(DiscrepancyTest, AWallCastsAShadowAwayFromTheLight) {
  HeightField relief{kSize, kSize, 100.0 / kSize, 100.0 / kSize,
                     std::vector<float>(kSize * kSize, 0.0f)};
  for (int row = 0; row < kSize; ++row) relief.height_mm[row * kSize + 16] = 20;
  for (float& v : maps_.planes) v = 0;
  for (float& z : maps_.plane(kNormalZ)) z = 1;
  for (float& d : maps_.plane(kDiffuseR)) d = 0.5f;
  for (float& r : maps_.plane(kRoughness)) r = 1;
  discrepancy_.relief = true;
  view_.camera_in_sample_mm = {0, 0, 1e6};  // no parallax
  view_.light_in_sample_mm = {100, 0, 60};  // from the right
  const std::vector<float> rgb =
      RenderDiscrepant(discrepancy_, drawn_, maps_, relief, plane_, view_, convention_, 2);
  const float left_of_wall = rgb[16 * kSize + 13], right_of_wall = rgb[16 * kSize + 20];
  EXPECT_LT(left_of_wall, 0.3f * right_of_wall);
}

TEST_F(DiscrepancyTest, HighTexelsMoveAwayFromTheCamerasFoot) {
  HeightField relief{kSize, kSize, 100.0 / kSize, 100.0 / kSize,
                     std::vector<float>(kSize * kSize, 10.0f)};
  for (float& v : maps_.planes) v = 0;
  for (float& z : maps_.plane(kNormalZ)) z = 1;
  for (float& r : maps_.plane(kRoughness)) r = 1;
  for (int row = 0; row < kSize; ++row) maps_.at(kDiffuseR, row, 20) = 1;
  discrepancy_.relief = true;
  view_.camera_in_sample_mm = {-200, 0, 200};
  view_.light_in_sample_mm = {0, 0, 1e4};
  view_.light_rgb = {1e8, 1e8, 1e8};
  const std::vector<float> rgb =
      RenderDiscrepant(discrepancy_, drawn_, maps_, relief, plane_, view_, convention_, 1);
  const auto row = rgb.begin() + 16 * kSize;
  const auto brightest = std::max_element(row, row + kSize) - row;
  EXPECT_GT(brightest, 21);  // 10 mm high, seen at about 45 to 50°: 3 to 4 texels of 3 mm
  EXPECT_LT(brightest, 26);
}

TEST(Discrepancy, ViewsAreTheSameForAnyNumberOfThreadsAndNestedBySeed) {
  ViewSetOptions options;
  options.rule = "flash";
  options.count = 3;
  options.discrepancy = 1;
  const SvbrdfMaps maps = MakeMaterial(77, kSize, kSize);
  const PlannedViews three = PlanViews(options, 4, kSize, kSize);
  const RectifiedImage one = RenderPlannedView(maps, three, 1, options, 1);
  EXPECT_EQ(one.rgb, RenderPlannedView(maps, three, 1, options, 3).rgb);
  options.count = 5;
  EXPECT_EQ(one.rgb,
            RenderPlannedView(maps, PlanViews(options, 4, kSize, kSize), 1, options, 1).rgb);
  options.discrepancy = 0;
  EXPECT_NE(one.rgb,
            RenderPlannedView(maps, PlanViews(options, 4, kSize, kSize), 1, options, 1).rgb);
}

TEST(Discrepancy, FlashViewsAreNearTheTop) {
  ViewSetOptions options;
  options.rule = "flash";
  options.count = 40;
  for (const View& view : PlanViews(options, 4, kSize, kSize).views) {
    const Vec3d& c = view.camera_in_sample_mm;
    const double distance = std::hypot(c[0], c[1], c[2]);
    EXPECT_GE(distance, 3 * 50 - 1e-6);
    EXPECT_LE(distance, 5 * 50 + 1e-6);
    EXPECT_LE(std::acos(c[2] / distance) * 180 / M_PI, 20 + 1e-6);
    EXPECT_NEAR(view.light_in_sample_mm[0] - c[0], 12, 1e-9);
  }
}

TEST(Discrepancy, JpegKeepsPicturesNearlyAsTheyWere) {
  std::vector<unsigned char> codes(3 * 64 * 64);
  for (size_t i = 0; i < codes.size(); ++i) codes[i] = static_cast<unsigned char>(60 + i * i % 40);
  const std::vector<unsigned char> back = JpegRoundTrip(codes, 64, 64, 92);
  ASSERT_EQ(back.size(), codes.size());
  EXPECT_NE(back, codes);
  for (size_t i = 0; i < codes.size(); ++i) EXPECT_NEAR(back[i], codes[i], 60);
}

}  // namespace
}  // namespace glint
