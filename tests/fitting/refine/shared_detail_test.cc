// A photograph that is blurred more than the others gets what they show and it does not, as far as
// they tell it; others stay as they are.
#include "fitting/refine/shared_detail.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "base/resampling/resampling.h"
#include "fitting/refine/view_sharpness.h"

namespace glint {
namespace {

constexpr int kWidth = 192, kHeight = 224;
constexpr size_t kPictureTexels = static_cast<size_t>(kWidth) * kHeight;

// Noise with ever less power at higher frequencies, as textures have.
std::vector<float> Texture(unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<float> normal(0.0f, 0.12f);
  std::vector<float> white(kPictureTexels), texture(kPictureTexels, 0.0f);
  for (const double variance : {0.3, 1.5, 6.0}) {
    for (float& value : white) value = normal(random);
    const std::vector<float> smooth = PointSpread(variance).Blurred(white, kWidth, kHeight);
    for (size_t t = 0; t < kPictureTexels; ++t) texture[t] += smooth[t];
  }
  return texture;
}

// Six photographs that mix an albedo and two slopes, each in its own proportion, and noise.
PhotographSet Photographs(double noise = 0.003) {
  const std::vector<float> factors[3] = {Texture(1), Texture(2), Texture(3)};
  constexpr float kShares[6][3] = {{1.0f, 0.1f, -0.2f}, {0.9f, 0.7f, 0.1f},  {1.1f, -0.6f, 0.2f},
                                   {1.0f, 0.2f, 0.8f},  {0.8f, 0.5f, -0.7f}, {1.0f, -0.4f, -0.5f}};
  std::mt19937 random(9);
  std::normal_distribution<float> normal(0.0f, static_cast<float>(noise));
  PhotographSet set;
  set.plane = {.width = kWidth, .height = kHeight, .width_mm = 60, .height_mm = 70};
  for (const auto& shares : kShares) {
    Photograph photograph;
    photograph.ldr = false;
    photograph.mask.assign(kPictureTexels, 1.0f);
    for (const float level : {0.4f, 0.3f, 0.2f}) {
      for (size_t t = 0; t < kPictureTexels; ++t) {
        float log = std::log(level) + normal(random);
        for (size_t f = 0; f < 3; ++f) log += shares[f] * factors[f][t];
        photograph.rgb.push_back(std::exp(log));
      }
    }
    photograph.pixels_per_texel = 2;
    photograph.blur_px = 0.6;
    set.photographs.push_back(photograph);
  }
  return set;
}

// By a Gaussian of that many texels², which the photograph is said to have if `measured`.
void Blur(double variance, bool measured, Photograph* photograph) {
  photograph->rgb = PointSpread(variance).Blurred(photograph->rgb, kWidth, kHeight);
  if (measured) photograph->blur_px = std::hypot(photograph->blur_px, 2 * std::sqrt(variance));
}

double DifferenceOf(const Photograph& a, const Photograph& b) {
  double sum = 0;
  for (size_t i = 0; i < a.rgb.size(); ++i) {
    const double difference = std::log((a.rgb[i] + 0.01) / (b.rgb[i] + 0.01));
    sum += difference * difference;
  }
  return std::sqrt(sum / static_cast<double>(a.rgb.size()));
}

TEST(SharedDetail, ABlurredPhotographIsNearlyAsIfItWereSharp) {
  const PhotographSet sharp = Photographs();
  PhotographSet set = sharp;
  Blur(1.5, true, &set.photographs[4]);
  const PhotographSet before = set;
  const SharedDetail shared(set, {}, 2);
  ASSERT_GT(shared.RowsAbout(), 0);
  shared.AddTo(&set, 2);
  EXPECT_LT(DifferenceOf(set.photographs[4], sharp.photographs[4]),
            0.5 * DifferenceOf(before.photographs[4], sharp.photographs[4]));
  // What is still hidden is stated: not more than was, and more than nothing.
  const double stated = std::sqrt(set.photographs[4].hidden_variance);
  EXPECT_GT(stated, 0.003);
  EXPECT_LT(stated, 0.5 * DifferenceOf(before.photographs[4], sharp.photographs[4]));
  for (const size_t v : {0, 1, 2, 3, 5}) {
    EXPECT_EQ(set.photographs[v].rgb, before.photographs[v].rgb);
    EXPECT_EQ(set.photographs[v].hidden_variance, 0);
  }
  // As sharp as the least sharp of the sharper half.
  const double aim = PointSpread(2, std::hypot(0.6, 0.33)).variance();
  EXPECT_NEAR(set.photographs[4].spread_variance.value(), aim, 1e-9);
}

TEST(SharedDetail, PhotographsThatAreAllAsSharpStayAsTheyAre) {
  PhotographSet set = Photographs();
  for (Photograph& photograph : set.photographs) Blur(0.8, true, &photograph);
  set.photographs[2].blur_px *= 1.03;  // measured, too
  const SharedDetail shared(set, {}, 2);
  EXPECT_EQ(shared.RowsAbout(), 0);
  const std::vector<float> before = set.photographs[2].rgb;
  shared.AddTo(&set, 2);
  EXPECT_EQ(set.photographs[2].rgb, before);
}

// A photograph from farther off is coarser.
TEST(SharedDetail, APhotographFromFartherOffIsAsIfItWereNear) {
  const PhotographSet sharp = Photographs();
  PhotographSet set = sharp;
  Photograph& far = set.photographs[4];
  far.pixels_per_texel = 0.5;
  RefineView view;
  view.pixels_per_texel = far.pixels_per_texel;
  view.blur_px = far.blur_px;
  far.rgb = PointSpread(SpreadOf(view, {}).variance()).Blurred(far.rgb, kWidth, kHeight);
  const PhotographSet before = set;
  SharedDetail(set, {}, 2).AddTo(&set, 2);
  EXPECT_LT(DifferenceOf(far, sharp.photographs[4]),
            0.5 * DifferenceOf(before.photographs[4], sharp.photographs[4]));
  EXPECT_LT(far.spread_variance.value(), 0.1);
}

// Only one photograph has it: nothing of the others is a combination of it.
TEST(SharedDetail, DetailThatOthersDoNotHaveIsNotMadeUp) {
  PhotographSet set = Photographs();
  const std::vector<float> other = Texture(7);
  Photograph& alone = set.photographs[1];
  for (size_t i = 0; i < alone.rgb.size(); ++i) {
    alone.rgb[i] = 0.3f * std::exp(other[i % kPictureTexels]);
  }
  const Photograph sharp = alone;
  Blur(1.5, true, &alone);
  const Photograph before = alone;
  SharedDetail(set, {}, 2).AddTo(&set, 2);
  EXPECT_LT(DifferenceOf(set.photographs[1], before), 0.3 * DifferenceOf(sharp, before));
  EXPECT_GT(set.photographs[1].hidden_variance, 0.5 * std::pow(DifferenceOf(sharp, before), 2));
}

TEST(SharedDetail, ClippedAndMaskedTexelsStay) {
  PhotographSet set = Photographs();
  Photograph& blurred = set.photographs[4];
  Blur(1.5, true, &blurred);
  blurred.ldr = true;
  const size_t clipped = 100 * kWidth + 90, masked = 50 * kWidth + 40, bright = 150 * kWidth + 90;
  blurred.rgb[clipped] = 1.0f;
  for (int row = 148; row < 153; ++row) {  // hardly below the limit
    for (int column = 88; column < 93; ++column) {
      blurred.rgb[static_cast<size_t>(row) * kWidth + static_cast<size_t>(column)] = 0.985f;
    }
  }
  blurred.mask[masked] = 0;
  blurred.rgb[masked] = NAN;
  set.photographs[0].mask[masked + 500] = 0;
  set.photographs[0].rgb[masked + 500] = NAN;
  SharedDetail(set, {}, 2).AddTo(&set, 2);
  EXPECT_EQ(blurred.rgb[clipped], 1.0f);
  EXPECT_LT(blurred.rgb[bright], 0.99f);
  EXPECT_GT(blurred.rgb[bright], 0.9f);
  for (size_t i = 0; i < blurred.rgb.size(); ++i) {
    ASSERT_TRUE(i == masked || std::isfinite(blurred.rgb[i])) << i;
  }
}

TEST(SharedDetail, RowsAndThreadsDoNotChangeABit) {
  PhotographSet whole = Photographs();
  Blur(1.5, true, &whole.photographs[4]);
  Blur(0.6, true, &whole.photographs[1]);
  const PhotographSet before = whole;
  const SharedDetail shared(before, {}, 1), again(before, {}, 3);
  shared.AddTo(&whole, 3);
  constexpr int kFirst = 85, kRows = 21;
  const int above = std::min(kFirst, again.RowsAbout());
  const int below = std::min(kHeight - kFirst - kRows, again.RowsAbout());
  PhotographSet part = before;
  part.plane = before.plane.Rows(kFirst - above, above + kRows + below);
  for (Photograph& photograph : part.photographs) {
    photograph.rgb =
        CutRows(photograph.rgb, kWidth, kHeight, kFirst - above, above + kRows + below);
    photograph.mask =
        CutRows(photograph.mask, kWidth, kHeight, kFirst - above, above + kRows + below);
  }
  again.AddTo(&part, 1);
  for (const size_t v : {1, 4}) {
    EXPECT_EQ(CutRows(part.photographs[v].rgb, kWidth, part.plane.height, above, kRows),
              CutRows(whole.photographs[v].rgb, kWidth, kHeight, kFirst, kRows));
  }
}

TEST(SharedDetail, NothingIsLentWhereABlurWasNotMeasured) {
  PhotographSet set = Photographs();
  Blur(1.5, true, &set.photographs[4]);
  EXPECT_TRUE(SharedDetail::MayLack(set, {}));
  set.photographs[1].blur_px = 0;
  EXPECT_FALSE(SharedDetail::MayLack(set, {}));
  EXPECT_EQ(SharedDetail(set, {}, 2).RowsAbout(), 0);
}

TEST(ViewSharpness, SpreadIsAsSaidAsMeasuredOrAsExpected) {
  RefineView view;
  view.pixels_per_texel = 1.4;
  view.blur_px = 1.7;
  EXPECT_EQ(SpreadOf(view, {}).variance(), PointSpread(1.4, std::hypot(1.7, 0.33)).variance());
  RefineOptions as_expected;
  as_expected.measured_blur = false;
  EXPECT_EQ(SpreadOf(view, as_expected).variance(), PointSpread(1.4, 0.67).variance());
  view.blur_px = 0;  // not known
  EXPECT_EQ(SpreadOf(view, {}).variance(), PointSpread(1.4, 0.67).variance());
  view.spread_variance = 0.3;
  EXPECT_EQ(SpreadOf(view, {}).variance(), 0.3);
}

TEST(ViewSharpness, WeightsAreThoseOfTheResidualsVariance) {
  RefineProblem problem;
  problem.views.resize(2);
  problem.views[1].hidden_variance = 0.03;
  WeighViews(0.01, &problem);
  EXPECT_EQ(problem.views[0].weight, 1);
  EXPECT_NEAR(problem.views[1].weight, 0.25, 1e-12);
}

}  // namespace
}  // namespace glint
