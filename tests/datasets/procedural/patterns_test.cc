#include "datasets/procedural/patterns.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <vector>

namespace glint::procedural {
namespace {

struct Cells {
  std::vector<float> u, v, edge;
  std::vector<uint32_t> id;
};

Cells TileSquare(const TilingOptions& options, int side, float extent) {
  std::vector<float> x, y;
  for (int i = 0; i < side * side; ++i) {
    x.push_back(extent * ((static_cast<float>(i % side) + 0.5f) / static_cast<float>(side) - 0.5f));
    y.push_back(extent * ((static_cast<float>(i / side) + 0.5f) / static_cast<float>(side) - 0.5f));
  }
  Cells c{std::vector<float>(x.size()), std::vector<float>(x.size()), std::vector<float>(x.size()),
          std::vector<uint32_t>(x.size())};
  Tile(options, x.data(), y.data(), side * side,
       {c.u.data(), c.v.data(), c.edge.data(), c.id.data()});
  return c;
}

class TilingTest : public ::testing::TestWithParam<Tiling> {};

TEST_P(TilingTest, CellsHaveTheirAreaAndMeetAtZeroEdge) {
  constexpr int kSide = 400;
  constexpr float kExtent = 20.0f;
  TilingOptions options;
  options.tiling = GetParam();
  options.frequency = 1.0f;
  options.aspect = 2;
  options.seed = 3;
  const Cells c = TileSquare(options, kSide, kExtent);
  const float step = kExtent / kSide;
  std::map<uint32_t, int> texels;
  for (size_t i = 0; i < c.id.size(); ++i) {
    ++texels[c.id[i]];
    ASSERT_GE(c.edge[i], -1e-4f);
    const bool last = i % kSide == kSide - 1;
    if (last || c.id[i] == c.id[i + 1]) continue;
    ASSERT_LE(std::min(c.edge[i], c.edge[i + 1]), step);
  }
  std::vector<int> sizes;
  for (const auto& [id, count] : texels) sizes.push_back(count);
  std::nth_element(sizes.begin(), sizes.begin() + sizes.size() / 2, sizes.end());
  const float area = static_cast<float>(sizes[sizes.size() / 2]) * step * step;
  const bool hexagon = GetParam() == Tiling::kHexagon;
  const bool voronoi = GetParam() == Tiling::kVoronoi;
  const float expected = hexagon ? 0.866f : voronoi ? 1.0f : 2.0f;
  EXPECT_NEAR(area, expected, voronoi ? 0.3f : 0.08f);
}

INSTANTIATE_TEST_SUITE_P(AllTilings, TilingTest,
                         ::testing::Values(Tiling::kGrid, Tiling::kRunningBond, Tiling::kThirdBond,
                                           Tiling::kRandomBond, Tiling::kHerringbone,
                                           Tiling::kBasket, Tiling::kHexagon, Tiling::kVoronoi));

TEST(StreaksTest, PresenceIsTheShareOfFilledSlots) {
  std::vector<float> x, y;
  for (int i = 0; i < 60000; ++i) {
    x.push_back(0.37f * static_cast<float>(i % 245));
    y.push_back(0.0137f * static_cast<float>(i));
  }
  std::vector<float> profile(x.size());
  std::vector<uint32_t> id(x.size());
  for (const float presence : {0.1f, 0.6f}) {
    StreakOptions options;
    options.presence = presence;
    options.lanes = 3.0f;
    options.width = 1.0f;
    options.angle_turns = 0.07f;
    Streaks(options, x.data(), y.data(), static_cast<int>(x.size()), 1e-3f, profile.data(),
            id.data());
    int inside = 0;
    for (const float v : profile) {
      ASSERT_TRUE(v >= 0.0f && v <= 1.0f);
      inside += v > 0.0f ? 1 : 0;
    }
    EXPECT_NEAR(static_cast<float>(inside) / 60000.0f, presence, 0.02f);
  }
}

}  // namespace
}  // namespace glint::procedural
