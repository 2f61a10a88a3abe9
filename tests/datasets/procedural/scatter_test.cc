#include "datasets/procedural/scatter.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <vector>

namespace glint::procedural {
namespace {

constexpr int kSide = 300;

struct Strewn {
  std::vector<float> u, v, inset;
  std::vector<uint32_t> id;
};

Strewn Scatter(const ScatterOptions& options) {
  std::vector<float> x, y;
  for (int i = 0; i < kSide * kSide; ++i) {
    x.push_back(0.01f * static_cast<float>(i % kSide) - 1.7f);
    y.push_back(0.01f * static_cast<float>(i / kSide) + 0.4f);
  }
  Strewn s{std::vector<float>(x.size()), std::vector<float>(x.size()), std::vector<float>(x.size()),
           std::vector<uint32_t>(x.size())};
  ScatterThings(options, x.data(), y.data(), kSide * kSide, 1e-4f,
                {s.u.data(), s.v.data(), s.inset.data(), s.id.data()});
  return s;
}

double Cover(const Strewn& s) {
  double covered = 0;
  for (const float inset : s.inset) covered += inset > 0 ? 1 : 0;
  return covered / static_cast<double>(s.inset.size());
}

TEST(ScatterTest, CoverFollowsSizeAndPresence) {
  ScatterOptions o;
  o.square = 1;
  o.half_length = 0.4f;
  o.half_width = 0.3f;
  // Things of area a strewn evenly at one a cell leave about exp(−a) bare, here a little less.
  EXPECT_NEAR(Cover(Scatter(o)), 1 - std::exp(-4 * 0.4 * 0.3), 0.07);
  o.presence = 0.25f;
  EXPECT_NEAR(Cover(Scatter(o)), 1 - std::exp(-0.25 * 4 * 0.4 * 0.3), 0.03);
  o.presence = 0;
  EXPECT_EQ(Cover(Scatter(o)), 0);
}

TEST(ScatterTest, CoordinatesRunFromEndToEndOfEveryThing) {
  ScatterOptions o;
  o.half_width = 0.2f;
  const Strewn s = Scatter(o);
  float least = 1, most = -1;
  for (size_t i = 0; i < s.u.size(); ++i) {
    if (s.inset[i] <= 0) continue;
    ASSERT_LE(s.u[i] * s.u[i] + std::fabs(s.v[i]), 1.0f);  // a leaf's outline
    ASSERT_NEAR(s.inset[i], 1 - s.u[i] * s.u[i] - std::fabs(s.v[i]), 1e-5f);
    least = std::min(least, s.u[i]);
    most = std::max(most, s.u[i]);
  }
  EXPECT_LT(least, -0.9f);
  EXPECT_GT(most, 0.9f);
}

TEST(ScatterTest, ThingsOfOneDirectionAreLongAlongIt) {
  ScatterOptions o;
  o.half_length = 1.0f;
  o.half_width = 0.1f;
  o.angle_spread = 0;  // along x
  const Strewn s = Scatter(o);
  int along = 0, across = 0;
  for (int y = 0; y + 1 < kSide; ++y) {
    for (int x = 0; x + 1 < kSide; ++x) {
      const size_t i = static_cast<size_t>(y) * kSide + x;
      along += s.id[i] != s.id[i + 1] ? 1 : 0;
      across += s.id[i] != s.id[i + kSide] ? 1 : 0;
    }
  }
  EXPECT_GT(across, 3 * along);
}

}  // namespace
}  // namespace glint::procedural
