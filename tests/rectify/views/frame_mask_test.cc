#include "rectify/views/frame_mask.h"

#include <gtest/gtest.h>

namespace glint {
namespace {

SamplePlane Plane() {
  SamplePlane plane;
  plane.width = plane.height = 100;
  plane.width_mm = plane.height_mm = 100;  // texel centres at −49.5 … 49.5
  return plane;
}

View ViewFrom(Vec3d camera, Vec3d light) {
  View view;
  view.camera_in_sample_mm = camera;
  view.light_in_sample_mm = light;
  return view;
}

bool Masked(const std::vector<TexelStatus>& status, int row, int column) {
  return status[static_cast<size_t>(row) * 100 + column] == TexelStatus::kMasked;
}

TEST(FrameMask, OpeningIsTheWindowInTheSampleFrame) {
  Board board;
  board.squares_x = 12;
  board.squares_y = 10;
  board.square_mm = 10;
  board.window = BoardWindow{2, 3, 8, 5};
  board.board_centre_in_sample_mm = {1, -2};
  const BoardRectangle opening = *OpeningInSample(board);
  EXPECT_DOUBLE_EQ(opening.left_mm, 1 - 60 + 20);
  EXPECT_DOUBLE_EQ(opening.right_mm, 1 - 60 + 100);
  EXPECT_DOUBLE_EQ(opening.top_mm, -2 + 50 - 30);
  EXPECT_DOUBLE_EQ(opening.bottom_mm, -2 + 50 - 80);
}

TEST(FrameMask, MasksWhatLiesUnderTheFrame) {
  const auto status =
      MaskFrame(Plane(), {-40, -30, 45, 50}, 0, 0, ViewFrom({0, 0, 300}, {0, 0, 300}));
  EXPECT_TRUE(Masked(status, 50, 9));    // x = −40.5
  EXPECT_FALSE(Masked(status, 50, 10));  // x = −39.5
  EXPECT_FALSE(Masked(status, 50, 94));  // x = 44.5
  EXPECT_TRUE(Masked(status, 50, 95));
  EXPECT_FALSE(Masked(status, 0, 50));  // y = 49.5: row 0 is at +y
  EXPECT_FALSE(Masked(status, 79, 50));
  EXPECT_TRUE(Masked(status, 80, 50));  // y = −30.5
}

// A frame 5 mm high, light 100 mm up and 100 mm to the left of the left edge: it shades
// 5·(distance)/(100 − 5) of the sample beside that edge.
TEST(FrameMask, MasksTheFramesShadow) {
  const BoardRectangle opening{-40, -50, 50, 50};
  const auto status = MaskFrame(Plane(), opening, 5, 0, ViewFrom({-40, 0, 1e9}, {-140, 0, 100}));
  const double shadow_mm = 5 * 100.0 / 95;  // 5.26: texel centres −39.5 … −34.5 lie in −40 … −34.7
  EXPECT_TRUE(Masked(status, 50, static_cast<int>(-40 + shadow_mm - 0.5 + 50)));
  EXPECT_FALSE(Masked(status, 50, static_cast<int>(-40 + shadow_mm + 1 + 50)));
  EXPECT_FALSE(Masked(status, 50, 98));  // the far edge is lit
}

TEST(FrameMask, MasksWhatTheFrameHidesFromTheCamera) {
  const auto status =
      MaskFrame(Plane(), {-40, -50, 50, 50}, 5, 0, ViewFrom({-140, 0, 100}, {-40, 0, 1e9}));
  EXPECT_TRUE(Masked(status, 50, 14));
  EXPECT_FALSE(Masked(status, 50, 17));
}

TEST(FrameMask, MarginWidensTheFrame) {
  const auto status =
      MaskFrame(Plane(), {-50, -50, 50, 50}, 0, 3, ViewFrom({0, 0, 300}, {0, 0, 300}));
  EXPECT_TRUE(Masked(status, 50, 2));
  EXPECT_FALSE(Masked(status, 50, 3));
}

}  // namespace
}  // namespace glint
