#include "base/reflectance/border.h"

#include <gtest/gtest.h>

namespace glint {
namespace {

// Every value says where it was.
SvbrdfMaps Numbered(int width, int height) {
  SvbrdfMaps maps(width, height);
  for (size_t i = 0; i < maps.planes.size(); ++i) maps.planes[i] = static_cast<float>(i);
  return maps;
}

TEST(ContinueBorder, RingsTakeTheNearestTexelFurtherIn) {
  const SvbrdfMaps before = Numbered(9, 7);
  SvbrdfMaps maps = before;
  ContinueBorder(&maps, 2);
  for (const int plane : {kNormalX, kRoughness}) {
    EXPECT_EQ(maps.at(plane, 0, 0), before.at(plane, 2, 2));
    EXPECT_EQ(maps.at(plane, 1, 4), before.at(plane, 2, 4));
    EXPECT_EQ(maps.at(plane, 3, 8), before.at(plane, 3, 6));
    EXPECT_EQ(maps.at(plane, 6, 7), before.at(plane, 4, 6));
    EXPECT_EQ(maps.at(plane, 3, 4), before.at(plane, 3, 4));
  }
}

TEST(ContinueBorder, NoRingsOrNoRoomLeaveMapsAlone) {
  const SvbrdfMaps before = Numbered(5, 4);
  for (const auto& [size, rings] : {std::pair{before, 0}, {Numbered(1, 1), 3}}) {
    SvbrdfMaps maps = size;
    ContinueBorder(&maps, rings);
    EXPECT_EQ(maps.planes, size.planes);
  }
  SvbrdfMaps maps = before;
  ContinueBorder(&maps, 64);
  EXPECT_EQ(maps.at(kNormalX, 0, 0), before.at(kNormalX, 1, 1));
}

}  // namespace
}  // namespace glint
