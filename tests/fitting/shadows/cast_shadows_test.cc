// Shadows that a relief casts are told from dark texels, from texels that are turned away, and from
// gloss.
#include "fitting/shadows/cast_shadows.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>
#include <random>

namespace glint {
namespace {

constexpr int kSide = 24;
constexpr size_t kTexels = kSide * kSide, kLights = 48;
constexpr float kAlbedo = 0.4f;

using Normal = std::array<double, 3>;

// A matte sample with slopes of this standard deviation under a dome.
class CastShadows : public ::testing::Test {
 protected:
  void Make(double slope_sd) {
    set_ = {};
    set_.plane.width = set_.plane.height = kSide;
    set_.plane.width_mm = set_.plane.height_mm = 100;
    set_.convention = ReflectanceConvention::Photograph();
    std::mt19937 engine(3);
    const auto deviate = [&] {
      double sum = -6;
      for (int i = 0; i < 12; ++i) sum += static_cast<double>(engine()) / 4294967296.0;
      return sum;
    };
    normals_.clear();
    for (size_t t = 0; t < kTexels; ++t) {
      const double x = slope_sd * deviate(), y = slope_sd * deviate();
      const double length = std::sqrt(1 + x * x + y * y);
      normals_.push_back({x / length, y / length, 1 / length});
    }
    for (size_t v = 0; v < kLights; ++v) {
      const double z = 0.2 + 0.75 * (static_cast<double>(v) + 0.5) / kLights;
      const double side = std::sqrt(1 - z * z), azimuth = 2.4 * static_cast<double>(v);
      Photograph photograph;
      photograph.view.light_in_sample_mm = {1000 * side * std::cos(azimuth),
                                            1000 * side * std::sin(azimuth), 1000 * z};
      photograph.view.camera_in_sample_mm = {0, 0, 1000};
      photograph.view.light_rgb.fill(1e6 * std::numbers::pi);
      photograph.rgb.assign(3 * kTexels, 0.0f);
      photograph.mask.assign(kTexels, 1.0f);
      for (size_t t = 0; t < kTexels; ++t) SetRadiance(Lit(photograph.view, t), t, &photograph);
      set_.photographs.push_back(std::move(photograph));
    }
  }
  float Lit(const View& view, size_t texel) const {
    const double x = set_.plane.x_mm(static_cast<int>(texel) % kSide);
    const double y = set_.plane.y_mm(static_cast<int>(texel) / kSide);
    const Vec3d& light = view.light_in_sample_mm;
    const Normal to = {light[0] - x, light[1] - y, light[2]};
    const double square = to[0] * to[0] + to[1] * to[1] + to[2] * to[2];
    const Normal& n = normals_[texel];
    const double cosine = (n[0] * to[0] + n[1] * to[1] + n[2] * to[2]) / std::sqrt(square);
    return static_cast<float>(kAlbedo * std::max(0.0, cosine) * 1e6 / square);
  }
  static void SetRadiance(float radiance, size_t texel, Photograph* photograph) {
    for (size_t c = 0; c < 3; ++c) photograph->rgb[c * kTexels + texel] = radiance;
  }
  // Every fifth texel under lights lower than this sine, all from one side.
  static bool Hidden(const Photograph& photograph, size_t texel) {
    const Vec3d& light = photograph.view.light_in_sample_mm;
    return texel % 5 == 0 && light[0] > 0 && light[2] < 350;
  }
  void Hide() {
    for (Photograph& photograph : set_.photographs) {
      for (size_t t = 0; t < kTexels; ++t) {
        if (Hidden(photograph, t)) SetRadiance(0.05f * Lit(photograph.view, t), t, &photograph);
      }
    }
  }
  size_t Masked() const {
    size_t masked = 0;
    for (const Photograph& photograph : set_.photographs) {
      for (const float mask : photograph.mask) masked += mask == 0;
    }
    return masked;
  }

  // All the relief is finer than the maps that are known of it.
  HidingRelief Unresolved(double slope_sd) const {
    const HeightField level{kSide, kSide, 100.0 / kSide, 100.0 / kSide,
                            std::vector<float>(kTexels, 0.0f)};
    return {Horizon(level, set_.plane), slope_sd};
  }

  PhotographSet set_;
  std::vector<Normal> normals_;
};

TEST_F(CastShadows, SlopesOfTheReliefAreFound) {
  for (const double slope : {0.05, 0.25}) {
    Make(slope);
    EXPECT_NEAR(ReliefSlopeSd(set_, 2), slope, 0.05 * slope + 0.005);
  }
}

TEST_F(CastShadows, AreTakenOutAndLittleElse) {
  Make(0.25);
  Hide();
  MaskCastShadows(Unresolved(ReliefSlopeSd(set_, 2)), 2, &set_);
  size_t hidden = 0, found = 0, wrong = 0, lit = 0;
  for (const Photograph& photograph : set_.photographs) {
    for (size_t t = 0; t < kTexels; ++t) {
      if (Lit(photograph.view, t) < 0.2f * kAlbedo) continue;  // dark by itself
      const bool masked = photograph.mask[t] == 0;
      (Hidden(photograph, t) ? hidden : lit) += 1;
      if (masked) ++(Hidden(photograph, t) ? found : wrong);
    }
  }
  ASSERT_GT(hidden, 100u);
  EXPECT_GT(static_cast<double>(found), 0.9 * static_cast<double>(hidden));
  EXPECT_LT(static_cast<double>(wrong), 0.001 * static_cast<double>(lit));
}

// A relief that faces away from a light is dark by itself, which tells its normals.
TEST_F(CastShadows, TexelsThatAreTurnedAwayStay) {
  Make(0.3);
  MaskCastShadows(Unresolved(ReliefSlopeSd(set_, 2)), 2, &set_);
  EXPECT_EQ(Masked(), 0u);
}

TEST_F(CastShadows, GlossIsNone) {
  Make(0.25);
  for (Photograph& photograph : set_.photographs) {
    const Vec3d& light = photograph.view.light_in_sample_mm;
    for (size_t t = 0; t < kTexels; ++t) {
      const Normal& n = normals_[t];
      const double off = std::hypot(n[0] - light[0] / 2000, n[1] - light[1] / 2000);
      const float gloss = 0.3f * static_cast<float>(std::exp(-off * off / (2 * 0.15 * 0.15)));
      SetRadiance(Lit(photograph.view, t) + gloss, t, &photograph);
    }
  }
  MaskCastShadows(Unresolved(ReliefSlopeSd(set_, 2)), 2, &set_);
  EXPECT_LT(static_cast<double>(Masked()), 0.002 * kTexels * kLights);
}

// What is dark on a level sample is something else.
TEST_F(CastShadows, LevelSampleCastsNone) {
  Make(0.01);
  Hide();
  MaskCastShadows(Unresolved(0.01), 1, &set_);
  EXPECT_EQ(Masked(), 0u);
}

// A metal is dark wherever its highlight is not: only the relief's heights tell its shadows.
TEST_F(CastShadows, OfAMetalsRidgeAreFoundByItsHeights) {
  Make(0);
  HeightField ridge{kSide, kSide, 100.0 / kSide, 100.0 / kSide, std::vector<float>(kTexels, 0.0f)};
  constexpr int kRidge = 14;
  for (int row = 0; row < kSide; ++row) {
    ridge.height_mm[static_cast<size_t>(row) * kSide + kRidge] = 8;
  }
  const HidingRelief relief{Horizon(ridge, set_.plane), 0};
  const auto hidden = [&](const Photograph& photograph, size_t t) {
    return relief.horizon.HiddenShare(set_.plane.x_mm(static_cast<int>(t) % kSide),
                                      set_.plane.y_mm(static_cast<int>(t) / kSide),
                                      photograph.view.light_in_sample_mm);
  };
  for (Photograph& photograph : set_.photographs) {
    const Vec3d& light = photograph.view.light_in_sample_mm;
    const double off = std::hypot(light[0], light[1]) / 1000;
    const auto lobe = static_cast<float>(0.01 + 2 * std::exp(-off * off / (2 * 0.3 * 0.3)));
    for (size_t t = 0; t < kTexels; ++t) {
      SetRadiance(hidden(photograph, t) > 0.5 ? 0 : lobe, t, &photograph);
    }
  }
  PhotographSet by_gloss_alone = set_;
  MaskCastShadows(relief, 2, &set_);
  MaskCastShadows(Unresolved(0), 2, &by_gloss_alone);
  size_t in_shadow = 0, found = 0, lit = 0, wrong = 0;
  for (const Photograph& photograph : set_.photographs) {
    for (size_t t = 0; t < kTexels; ++t) {
      const double share = hidden(photograph, t);
      const bool masked = photograph.mask[t] == 0;
      if (share > 0.99) {
        ++in_shadow;
        found += masked;
      } else if (share < 0.01) {
        ++lit;
        wrong += masked;
      }
    }
  }
  ASSERT_GT(in_shadow, 200u);
  EXPECT_GT(static_cast<double>(found), 0.98 * static_cast<double>(in_shadow));
  EXPECT_LT(static_cast<double>(wrong), 0.01 * static_cast<double>(lit));
  for (const Photograph& photograph : by_gloss_alone.photographs) {
    EXPECT_EQ(photograph.mask, std::vector<float>(kTexels, 1.0f));
  }
}

// What is bright is lit, whatever the heights say: those of initial maps may be wrong.
TEST_F(CastShadows, MatteTexelsThatAreBrightAreLit) {
  Make(0.05);
  HeightField wrong{kSide, kSide, 100.0 / kSide, 100.0 / kSide, std::vector<float>(kTexels, 0.0f)};
  for (int row = 0; row < kSide; ++row) wrong.height_mm[static_cast<size_t>(row) * kSide + 12] = 30;
  MaskCastShadows({Horizon(wrong, set_.plane), 0}, 2, &set_);
  EXPECT_EQ(Masked(), 0u);
}

TEST_F(CastShadows, SevenPhotographsStayAsTheyAre) {
  Make(0.25);
  Hide();
  set_.photographs.resize(7);
  EXPECT_EQ(ReliefSlopeSd(set_, 1), 0);
  MaskCastShadows(Unresolved(0.25), 1, &set_);
  EXPECT_EQ(Masked(), 0u);
}

TEST_F(CastShadows, DoNotDependOnTheNumberOfThreads) {
  Make(0.25);
  Hide();
  EXPECT_EQ(ReliefSlopeSd(set_, 1), ReliefSlopeSd(set_, 3));
  PhotographSet other = set_;
  MaskCastShadows(Unresolved(0.25), 1, &set_);
  MaskCastShadows(Unresolved(0.25), 3, &other);
  for (size_t v = 0; v < kLights; ++v) {
    EXPECT_EQ(set_.photographs[v].mask, other.photographs[v].mask);
  }
}

TEST_F(CastShadows, LowerLightsAndSteeperReliefsAreHiddenMoreOften) {
  EXPECT_EQ(ShadowedShare(0.2, 0), 0);
  EXPECT_GT(ShadowedShare(0.2, 0.3), ShadowedShare(0.4, 0.3));
  EXPECT_GT(ShadowedShare(0.2, 0.3), ShadowedShare(0.2, 0.2));
  EXPECT_NEAR(ShadowedShare(0.3, 0.3), 0.0769, 1e-4);  // Λ(ν) at ν = 1/√2
  EXPECT_LT(ShadowedShare(1, 0.1), 1e-12);
}

}  // namespace
}  // namespace glint
