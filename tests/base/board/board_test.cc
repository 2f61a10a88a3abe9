#include "base/board/board.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <opencv2/imgcodecs.hpp>
#include <set>

#include "base/board/aruco.h"
#include "tests/support/data_folder.h"

namespace glint {
namespace {

Board Charuco(int x, int y) {
  Board board;
  board.squares_x = x;
  board.squares_y = y;
  board.square_mm = 20;
  board.marker_mm = 14;
  board.dictionary = "DICT_5X5_100";
  return board;
}

// The board drawn with `pixels_per_mm`, as OpenCV's detector would see it from straight above.
cv::Mat Picture(const Board& board, double margin_mm, double pixels_per_mm) {
  const BoardPainter painter(board, margin_mm);
  const double half_width = 0.5 * board.squares_x * board.square_mm + margin_mm;
  const double half_height = 0.5 * board.squares_y * board.square_mm + margin_mm;
  cv::Mat picture(static_cast<int>(2 * half_height * pixels_per_mm),
                  static_cast<int>(2 * half_width * pixels_per_mm), CV_8U);
  for (int y = 0; y < picture.rows; ++y) {
    for (int x = 0; x < picture.cols; ++x) {
      const double x_mm =
          (x + 0.5) / pixels_per_mm - half_width + board.board_centre_in_sample_mm.x();
      const double y_mm =
          half_height - (y + 0.5) / pixels_per_mm + board.board_centre_in_sample_mm.y();
      picture.at<unsigned char>(y, x) =
          static_cast<unsigned char>(255 * painter.ReflectanceAt(x_mm, y_mm).value_or(0.5));
    }
  }
  return picture;
}

TEST(Board, CornersAreRowMajorFromTheTopLeftWithYUp) {
  Board board = Charuco(8, 6);
  board.board_centre_in_sample_mm = {3, -2};
  const auto corners = BoardCorners(board);
  ASSERT_EQ(corners.size(), 35u);
  EXPECT_EQ(corners[0].id, 0);
  EXPECT_TRUE(corners[0].position_in_sample_mm.isApprox(Eigen::Vector2d(-60 + 3, 40 - 2)));
  EXPECT_TRUE(corners[1].position_in_sample_mm.isApprox(Eigen::Vector2d(-40 + 3, 40 - 2)));
  EXPECT_EQ(corners[34].id, 34);
  EXPECT_TRUE(corners[34].position_in_sample_mm.isApprox(Eigen::Vector2d(60 + 3, -40 - 2)));
}

TEST(Board, AWindowTakesAwayWhatTouchesItAndRenumbersNothing) {
  Board full = Charuco(12, 12);
  full.dictionary = "DICT_5X5_1000";
  Board frame = full;
  frame.window = BoardWindow{3, 4, 6, 5};
  std::set<int> kept;
  for (const BoardCorner& corner : BoardCorners(frame)) {
    kept.insert(corner.id);
    const int column = corner.id % 11 + 1, row = corner.id / 11 + 1;
    EXPECT_FALSE(column >= 3 && column <= 9 && row >= 4 && row <= 9) << column << " " << row;
    EXPECT_EQ(corner.position_in_sample_mm, BoardCorners(full)[corner.id].position_in_sample_mm);
  }
  EXPECT_EQ(kept.size(), 121u - 7 * 6);
  EXPECT_EQ(BoardMarkers(frame).size(), 72u - 15);
  for (const BoardMarker& marker : BoardMarkers(frame)) {
    EXPECT_EQ(marker.corners_in_sample_mm[0],
              BoardMarkers(full)[marker.id].corners_in_sample_mm[0]);
  }
  const BoardPainter painter(frame, 5);
  EXPECT_FALSE(painter.ReflectanceAt(0, 0).has_value());
  EXPECT_FALSE(painter.ReflectanceAt(-126, 0).has_value());
  EXPECT_EQ(painter.ReflectanceAt(-124, 0), 1.0);
  EXPECT_EQ(painter.ReflectanceAt(-119, 119), 0.0);
}

// OpenCV's own detector reads the painted board: every id at the place BoardMarkers names.
class PaintedMarkers : public testing::TestWithParam<std::tuple<std::string, int, int, bool>> {};

TEST_P(PaintedMarkers, AreWhereTheDescriptionSays) {
  Board board = Charuco(std::get<1>(GetParam()), std::get<2>(GetParam()));
  board.dictionary = std::get<0>(GetParam());
  board.legacy_layout = std::get<3>(GetParam());
  board.board_centre_in_sample_mm = {7, 11};
  ASSERT_EQ(CheckBoard(board), "");
  constexpr double kScale = 4;
  const cv::Mat picture = Picture(board, 10, kScale);
  int number = 0;
  for (const char* name : {"DICT_4X4_50", "DICT_5X5_100", "DICT_6X6_250", "DICT_APRILTAG_36h11"}) {
    const int numbers[] = {cv::aruco::DICT_4X4_50, cv::aruco::DICT_5X5_100, cv::aruco::DICT_6X6_250,
                           cv::aruco::DICT_APRILTAG_36h11};
    if (board.dictionary == name) {
      std::vector<int> ids;
      std::vector<std::vector<cv::Point2f>> seen;
      cv::aruco::detectMarkers(picture, aruco::Dictionary(numbers[number]), seen, ids);
      const auto markers = BoardMarkers(board);
      ASSERT_EQ(ids.size(), markers.size());
      for (size_t i = 0; i < ids.size(); ++i) {
        for (int k = 0; k < 4; ++k) {
          const Eigen::Vector2d& at = markers[ids[i]].corners_in_sample_mm[k];
          const double x = (at.x() - 7 + 0.5 * board.squares_x * 20 + 10) * kScale - 0.5;
          const double y = (11 - at.y() + 0.5 * board.squares_y * 20 + 10) * kScale - 0.5;
          EXPECT_NEAR(seen[i][k].x, x, 1.5) << "marker " << ids[i] << " corner " << k;
          EXPECT_NEAR(seen[i][k].y, y, 1.5) << "marker " << ids[i] << " corner " << k;
        }
      }
    }
    ++number;
  }
}

INSTANTIATE_TEST_SUITE_P(Layouts, PaintedMarkers,
                         testing::Values(std::make_tuple("DICT_5X5_100", 8, 6, false),
                                         std::make_tuple("DICT_5X5_100", 8, 6, true),
                                         std::make_tuple("DICT_6X6_250", 7, 5, false),
                                         std::make_tuple("DICT_4X4_50", 5, 5, true),
                                         std::make_tuple("DICT_APRILTAG_36h11", 4, 3, false)));

TEST(Board, LegacyLayoutDiffersForEvenRowsOnly) {
  Board board = Charuco(8, 6);
  Board legacy = board;
  legacy.legacy_layout = true;
  EXPECT_TRUE(SquareIsBlack(board, 0, 0));
  EXPECT_FALSE(SquareIsBlack(legacy, 0, 0));
  board.squares_y = legacy.squares_y = 5;
  EXPECT_TRUE(SquareIsBlack(legacy, 0, 0));
}

TEST(Board, OpenCv47sPrintedBoardIsReproduced) {
  const auto file = test::DataFolder() / "calib/charuco_phone/ChArUco_Marker.png";
  if (!std::filesystem::exists(file)) GTEST_SKIP() << "no real data";
  const cv::Mat printed = cv::imread(file.string(), cv::IMREAD_GRAYSCALE);
  Board board = Charuco(7, 5);
  board.square_mm = 30;
  board.marker_mm = 15;
  board.dictionary = "DICT_6X6_250";
  const BoardPainter painter(board, 0);
  // The picture's margin is found from its first ink; its squares are 7 across.
  int left = 0, top = 0;
  const int middle = printed.rows / 10;
  while (printed.at<unsigned char>(middle, left) > 127) ++left;
  while (printed.at<unsigned char>(top, left + 2) > 127) ++top;
  const double scale = (printed.cols - 2.0 * left) / 210.0;
  int compared = 0, different = 0;
  for (int row = 1; row < 300; ++row) {
    for (int column = 1; column < 420; ++column) {
      const double x = 0.5 * column, y = 0.5 * row;
      const unsigned char seen = printed.at<unsigned char>(static_cast<int>(top + y * scale),
                                                           static_cast<int>(left + x * scale));
      different += (seen > 127) != (painter.ReflectanceAt(x - 105, 75 - y).value() > 0.5);
      ++compared;
    }
  }
  EXPECT_LT(different, compared / 50);  // sampling at the edges of cells
}

TEST(CheckBoard, SaysWhatIsWrong) {
  Board board = Charuco(8, 6);
  EXPECT_EQ(CheckBoard(board), "");
  board.marker_mm = 25;
  EXPECT_NE(CheckBoard(board).find("marker_mm: found 25"), std::string::npos);
  board = Charuco(8, 6);
  board.dictionary = "DICT_9X9";
  EXPECT_NE(CheckBoard(board).find("dictionary: found \"DICT_9X9\""), std::string::npos);
  board = Charuco(30, 30);
  EXPECT_NE(CheckBoard(board).find("need 450"), std::string::npos);
  board = Charuco(8, 6);
  board.window = BoardWindow{2, 2, 7, 2};
  EXPECT_NE(CheckBoard(board).find("window: found [2, 2, 7, 2]"), std::string::npos);
  board = Charuco(8, 6);
  board.window = BoardWindow{1, 1, 6, 4};
  EXPECT_NE(CheckBoard(board).find("four inner corners"), std::string::npos);
  board = Charuco(1, 6);
  EXPECT_NE(CheckBoard(board).find("squares: found [1, 6]"), std::string::npos);
  board = Charuco(8, 6);
  board.square_mm = -1;
  EXPECT_NE(CheckBoard(board).find("square_mm: found -1"), std::string::npos);
  board = Charuco(8, 6);
  board.kind = BoardKind::kCheckerboard;
  board.window = BoardWindow{2, 2, 2, 2};
  EXPECT_NE(CheckBoard(board).find("charuco"), std::string::npos);
}

}  // namespace
}  // namespace glint
