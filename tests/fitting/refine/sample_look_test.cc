#include "fitting/refine/sample_look.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>
#include <span>

#include "tests/fitting/refine/synthetic_scene.h"

namespace glint {
namespace {

using test::LevelSubstance;
using test::Photograph;
using test::SyntheticScene;

constexpr int kSize = 64, kPitch = 8;

bool IsPore(size_t texel) { return texel % kPitch == 3; }

// Dark, so that its highlights stand out.
SvbrdfMaps Varnish(float roughness) {
  SvbrdfMaps maps = LevelSubstance(kSize, roughness);
  for (size_t t = 0; t < maps.texels(); ++t) {
    for (int c = 0; c < 3; ++c) maps.plane(kDiffuseR + c)[t] *= 0.2f;
  }
  return maps;
}

// A glossy substance with rough lines of the same albedos, like a varnished wood with its pores.
SvbrdfMaps Pored() {
  SvbrdfMaps maps = Varnish(0.4f);
  for (size_t t = 0; t < maps.texels(); ++t) {
    if (IsPore(t)) maps.plane(kRoughness)[t] = 0.8f;
  }
  return maps;
}

// By log-normal factors.
void AddNoise(double sigma, SyntheticScene* scene) {
  std::mt19937 random(3);
  std::normal_distribution<double> normal(0, sigma);
  for (std::vector<float>& photograph : scene->photographs) {
    const size_t texels = photograph.size() / 3;
    for (size_t t = 0; t < texels; ++t) {
      const auto factor = static_cast<float>(std::exp(normal(random)));
      for (size_t c = 0; c < 3; ++c) photograph[c * texels + t] *= factor;
    }
  }
}

float MeanWhere(const std::vector<float>& values, bool pores) {
  double sum = 0, count = 0;
  for (size_t t = 0; t < values.size(); ++t) {
    if (IsPore(t) != pores) continue;
    sum += values[t];
    ++count;
  }
  return static_cast<float>(sum / count);
}

TEST(SampleLook, RoughLinesInAGlossySubstanceOfTheirColourHaveLessGloss) {
  SyntheticScene scene = Photograph(Pored(), 7);
  AddNoise(0.1, &scene);
  const RefineProblem problem = scene.Problem();
  const std::vector<float> gloss = SampleLook(problem, 1).GlossOf(problem, 1);
  EXPECT_LT(MeanWhere(gloss, true), -0.2f);
  EXPECT_NEAR(MeanWhere(gloss, false), 0, 0.05f);
  std::vector<float> pores;
  for (size_t t = 0; t < gloss.size(); ++t) {
    if (IsPore(t)) pores.push_back(gloss[t]);
  }
  // Told apart one by one.
  const double told = std::count_if(pores.begin(), pores.end(), [](float g) { return g < -0.1f; });
  EXPECT_GT(told / static_cast<double>(pores.size()), 0.9);
}

TEST(SampleLook, WhatIsNoiseAloneIsNoGloss) {
  SyntheticScene scene = Photograph(Varnish(0.4f), 7);
  AddNoise(0.3, &scene);
  const RefineProblem problem = scene.Problem();
  const std::vector<float> gloss = SampleLook(problem, 1).GlossOf(problem, 1);
  const double squares = std::inner_product(gloss.begin(), gloss.end(), gloss.begin(), 0.0);
  EXPECT_LT(std::sqrt(squares / static_cast<double>(gloss.size())), 0.06);
}

// A darker print under the same varnish differs by as much in all photographs.
TEST(SampleLook, ADarkerTexelIsNoLessGlossyForThat) {
  SyntheticScene scene = Photograph(LevelSubstance(kSize, 0.4f), 7);
  for (std::vector<float>& photograph : scene.photographs) {
    for (size_t t = 0; t < photograph.size(); ++t) {
      if (IsPore(t)) photograph[t] *= 0.5f;
    }
  }
  const RefineProblem problem = scene.Problem();
  const std::vector<float> gloss = SampleLook(problem, 1).GlossOf(problem, 1);
  EXPECT_NEAR(MeanWhere(gloss, true), MeanWhere(gloss, false), 0.05f);
}

TEST(SampleLook, RowsOfASampleHaveTheGlossTheyHaveInTheWhole) {
  const SyntheticScene scene = Photograph(Pored(), 5);
  const RefineProblem whole = scene.Problem();
  const SampleLook look(whole, 2);
  const std::vector<float> gloss = look.GlossOf(whole, 2);
  constexpr size_t kFirst = 20, kRows = 9, kTexels = kSize * kSize;
  RefineProblem rows = whole;
  rows.plane = whole.plane.Rows(kFirst, kRows);
  std::vector<std::vector<float>> photographs, masks;
  for (const RefineView& view : whole.views) {
    std::vector<float>& photograph = photographs.emplace_back();
    for (size_t c = 0; c < 3; ++c) {
      const auto plane = view.rgb.subspan(c * kTexels + kFirst * kSize, kRows * kSize);
      photograph.insert(photograph.end(), plane.begin(), plane.end());
    }
    masks.emplace_back(kRows * kSize, 1.0f);
  }
  for (size_t v = 0; v < rows.views.size(); ++v) {
    rows.views[v].rgb = photographs[v];
    rows.views[v].mask = masks[v];
  }
  const std::vector<float> part = look.GlossOf(rows, 1);
  ASSERT_EQ(part.size(), kRows * kSize);
  for (size_t t = 0; t < part.size(); ++t) EXPECT_EQ(part[t], gloss[kFirst * kSize + t]);
}

TEST(SampleLook, TwoPhotographsAndMaskedOnesTellNothing) {
  const SyntheticScene two = Photograph(Pored(), 2);
  const RefineProblem problem = two.Problem();
  for (const float g : SampleLook(problem, 1).GlossOf(problem, 1)) EXPECT_EQ(g, 0);
  SyntheticScene masked = Photograph(Pored(), 4);
  for (std::vector<float>& mask : masked.masks) std::fill(mask.begin(), mask.end(), 0.0f);
  const RefineProblem nothing = masked.Problem();
  for (const float g : SampleLook(nothing, 1).GlossOf(nothing, 1)) EXPECT_EQ(g, 0);
}

// From initial maps that know nothing of them. As one substance with the varnish they stay like it.
TEST(Refine, FindsRoughLinesInAGlossySubstance) {
  SyntheticScene scene = Photograph(Pored(), 7, 8);
  AddNoise(0.05, &scene);
  const auto roughness = [&](int substances, bool pores) {
    RefineOptions options;
    options.substances = substances;
    const RefineResult result = Refine(scene.Problem(), Varnish(0.5f), options, 2);
    const auto plane = result.maps.plane(kRoughness);
    return MeanWhere({plane.begin(), plane.end()}, pores);
  };
  EXPECT_NEAR(roughness(8, false), 0.4f, 0.02f);
  EXPECT_GT(roughness(8, true), 0.62f);
  EXPECT_LT(roughness(1, true), 0.58f);
}

}  // namespace
}  // namespace glint
