#include "fitting/relief/relief_slopes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace glint {
namespace {

using Slopes = std::array<std::vector<float>, 2>;

// n_x/n_z = −∂h/∂x and n_y/n_z = −∂h/∂y, y up, of waves of some twenty texels in all directions.
Slopes WaveSlopes(int width, int height) {
  Slopes slopes;
  for (int row = 0; row < height; ++row) {
    for (int column = 0; column < width; ++column) {
      const double x = column, y = -row;
      const double a = 0.2 * std::cos(0.3 * x + 0.2 * y), b = 0.15 * std::sin(0.25 * x - 0.35 * y);
      slopes[0].push_back(static_cast<float>(0.3 * a + 0.25 * b));
      slopes[1].push_back(static_cast<float>(0.2 * a - 0.35 * b));
    }
  }
  return slopes;
}

Slopes Noise(const Slopes& like, double sd) {
  std::mt19937 random(5);
  std::normal_distribution<float> normal(0, static_cast<float>(sd));
  Slopes noise = like;
  for (std::vector<float>& plane : noise) {
    for (float& value : plane) value = normal(random);
  }
  return noise;
}

Slopes Sum(Slopes a, const Slopes& b) {
  for (size_t i = 0; i < 2; ++i) {
    for (size_t t = 0; t < a[i].size(); ++t) a[i][t] += b[i][t];
  }
  return a;
}

double MeanSquare(const Slopes& slopes) {
  double sum = 0;
  for (const std::vector<float>& plane : slopes) {
    for (const float value : plane) sum += static_cast<double>(value) * value;
  }
  return sum / static_cast<double>(slopes[0].size());
}

double MeanSquare(Slopes a, Slopes b) {
  for (std::vector<float>& plane : b) {
    for (float& value : plane) value = -value;
  }
  return MeanSquare(Sum(std::move(a), b));
}

Slopes Relief(const Slopes& slopes, int width, int height, int threads = 1) {
  return SlopesOfRelief({slopes[0], slopes[1]}, width, height, 0, {0, height}, threads);
}

class ReliefSizes : public ::testing::TestWithParam<std::pair<int, int>> {};

// But for what the mirror at the border makes of waves.
TEST_P(ReliefSizes, SlopesOfAHeightFieldStayAsTheyAre) {
  const auto [width, height] = GetParam();
  const Slopes truth = WaveSlopes(width, height);
  EXPECT_LT(MeanSquare(Relief(truth, width, height), truth), 0.03 * MeanSquare(truth));
}

// Errors of the waves' own size: half of their power has curl, and most of the rest is in other
// frequencies.
TEST_P(ReliefSizes, ErrorsAreTakenAway) {
  const auto [width, height] = GetParam();
  const Slopes truth = WaveSlopes(width, height);
  const Slopes noise = Noise(truth, std::sqrt(0.5 * MeanSquare(truth)));
  const Slopes relief = Relief(Sum(truth, noise), width, height);
  EXPECT_LT(MeanSquare(relief, truth), 0.25 * MeanSquare(noise));
}

TEST_P(ReliefSizes, ErrorsAloneHaveNoRelief) {
  const auto [width, height] = GetParam();
  const Slopes noise = Noise(WaveSlopes(width, height), 0.1);
  EXPECT_LT(MeanSquare(Relief(noise, width, height)), 0.1 * MeanSquare(noise));
}

// Slopes that go round a centre have nothing but curl.
TEST_P(ReliefSizes, ATurnIsNoRelief) {
  const auto [width, height] = GetParam();
  Slopes turned = WaveSlopes(width, height);
  std::swap(turned[0], turned[1]);
  for (float& value : turned[0]) value = -value;
  EXPECT_LT(MeanSquare(Relief(turned, width, height)), 0.05 * MeanSquare(turned));
}

INSTANTIATE_TEST_SUITE_P(Sizes, ReliefSizes,
                         ::testing::Values(std::pair{128, 96}, std::pair{131, 127},
                                           std::pair{80, 1100}, std::pair{700, 90}));

TEST(SlopesOfRelief, AreTheSameWhateverRowsAreAskedForAndForAnyThreads) {
  const int width = 540, height = 1200;
  const Slopes truth = WaveSlopes(width, height), slopes = Sum(truth, Noise(truth, 0.05));
  const Slopes whole = Relief(slopes, width, height, 3);
  for (const RowSpan asked : {RowSpan{0, 1}, RowSpan{300, 700}, RowSpan{1100, 1200}}) {
    const RowSpan rows = RowsOfRelief(height, asked);
    Slopes some;
    for (size_t i = 0; i < 2; ++i) {
      some[i].assign(slopes[i].begin() + rows.first * width, slopes[i].begin() + rows.last * width);
    }
    const Slopes found = SlopesOfRelief({some[0], some[1]}, width, height, 0, asked, 1);
    for (size_t i = 0; i < 2; ++i) {
      const std::vector<float> expected(whole[i].begin() + asked.first * width,
                                        whole[i].begin() + asked.last * width);
      EXPECT_EQ(found[i], expected) << asked.first;
    }
  }
}

TEST(TiledAxis, TilesCoverAllTexelsAndSharesAddUpToOne) {
  for (const int length : {2, 10, 97, 511, 512, 513, 700, 1024, 4001}) {
    const TiledAxis axis(length);
    EXPECT_EQ(axis.first(0), 0);
    EXPECT_EQ(axis.first(axis.count() - 1) + axis.side(), length) << length;
    for (int texel = 0; texel < length; ++texel) {
      double sum = 0;
      for (int tile = 0; tile < axis.count(); ++tile) sum += axis.Share(tile, texel);
      EXPECT_NEAR(sum, 1, 1e-12) << length << ' ' << texel;
    }
    for (int tile = 1; tile < axis.count(); ++tile) {
      EXPECT_LE(axis.first(tile) - axis.first(tile - 1), axis.side() / 2) << length;
    }
  }
}

TEST(SampleHasRelief, NotOnAFewTexels) {
  EXPECT_FALSE(SampleHasRelief(9, 200));
  EXPECT_TRUE(SampleHasRelief(10, 10));
}

}  // namespace
}  // namespace glint
