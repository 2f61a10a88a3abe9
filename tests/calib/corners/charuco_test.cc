#include "calib/corners/detector.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <map>

#include "tests/calib/corners/detection_errors.h"
#include "tests/calib/testing/synthetic_photo.h"

namespace glint {
namespace {

using ::testing::AnyOf;
using testing::Charuco;
using testing::Checkerboard;
using testing::Errors;
using ::testing::HasSubstr;
using testing::LookAt;
using testing::PhoneCamera;
using testing::Photograph;
using testing::PhotoSettings;

// ≥ 7 boards under perspective: bias ≤ 0.02 px, RMS ≤ 0.15 px.
TEST(DetectCharuco, HasNoBiasUnderPerspectiveBlurAndNoise) {
  const Board board = Charuco(8, 6);
  const Camera camera = PhoneCamera();
  Errors all;
  for (int i = 0; i < 8; ++i) {
    const Rigid3 pose = LookAt(230 + 12 * i, 4 + 6 * i, 50 * i, -40 + 17 * i, {3.0 * i - 8, 4});
    PhotoSettings settings;
    settings.samples = 5;
    settings.blur_px = 0.5 + 0.1 * i;
    settings.seed = i;
    const auto detection = DetectBoard(Photograph(board, camera, pose, settings), board);
    EXPECT_GE(detection.corners.size(), 33u) << "board " << i << ": " << detection.problem;
    Errors one;
    Add(detection, camera, pose, &one);
    Add(detection, camera, pose, &all);
    std::printf("board %d: tilt %2d deg, %d corners, bias %.4f px, RMS %.4f px\n", i, 4 + 6 * i,
                one.corners, one.bias(), one.rms());
  }
  std::printf("all: %d corners, bias %.4f px, RMS %.4f px\n", all.corners, all.bias(), all.rms());
  EXPECT_LE(all.bias(), 0.02);
  EXPECT_LE(all.rms(), 0.15);
  EXPECT_EQ(all.wrong, 0);
}

// 8×6 squares with 0, 20, 40, 60 % covered: at least 35, 25, 20, 10 corners, none wrong.
class Cover : public ::testing::TestWithParam<double> {};  // reflectance of what covers

TEST_P(Cover, LeavesTheOtherCornersAndNoneWrong) {
  const Board board = Charuco(8, 6);
  const Camera camera = PhoneCamera();
  const int least[] = {35, 25, 20, 10};
  for (int step = 0; step < 4; ++step) {
    for (int side = step == 0 ? 2 : 0; side < 4; side += 2) {
      const double share = 0.2 * step;
      PhotoSettings settings;
      settings.samples = 2;
      settings.seed = step;
      settings.cover = [=](double x, double y) -> std::optional<double> {
        const double u = side == 0   ? x / 160 + 0.5
                         : side == 1 ? 0.5 - x / 160
                         : side == 2 ? y / 120 + 0.5
                                     : 0.5 - y / 120;
        // A little of structure: wood, cloth.
        if (u < share) return GetParam() * (1 + 0.3 * std::sin(x * 1.3) * std::sin(y * 0.7));
        return std::nullopt;
      };
      const Rigid3 pose = LookAt(240, 20, 30 + 90 * side, 10, {0, 0});
      const auto detection = DetectBoard(Photograph(board, camera, pose, settings), board);
      Errors errors;
      Add(detection, camera, pose, &errors);
      // Covered from the long side, 20 % more of the rows go than of the columns; the count is for
      // the short side.
      if (side < 2 || step == 0) {
        EXPECT_GE(errors.corners, least[step]) << share << " from side " << side;
      }
      EXPECT_EQ(errors.wrong, 0) << share << " from side " << side;
      if (side == 0 || step == 0)
        std::printf("%.0f %% covered: %d corners\n", 100 * share, errors.corners);
      for (const CornerObservation& corner : detection.corners) {
        const Eigen::Vector2d& at = corner.position_in_sample_mm;
        EXPECT_FALSE(settings.cover(at.x(), at.y())) << "a hidden corner was reported";
      }
    }
  }
}
INSTANTIATE_TEST_SUITE_P(Reflectances, Cover, ::testing::Values(0.02, 0.3, 0.8));

TEST(DetectCharuco, FindsAFrameRoundASample) {
  Board board = Charuco(12, 12);
  board.square_mm = 15;
  board.marker_mm = 11;
  board.dictionary = "DICT_5X5_1000";
  board.window = BoardWindow{3, 3, 6, 6};
  const Camera camera{CameraModel::kRadial, 1200, 900, {1050, 604.3, 447.1, 0.06, -0.08}};
  PhotoSettings settings;
  settings.cover = [](double x, double y) -> std::optional<double> {
    if (std::max(std::abs(x), std::abs(y)) > 44) return std::nullopt;
    return 0.3 + 0.25 * std::sin(x * 0.9) * std::sin(y * 0.8);
  };
  const Rigid3 pose = LookAt(270, 25, 130, 15);
  const auto detection = DetectBoard(Photograph(board, camera, pose, settings), board);
  Errors errors;
  Add(detection, camera, pose, &errors);
  EXPECT_GE(errors.corners, 70) << detection.problem;  // 72 exist
  EXPECT_EQ(errors.wrong, 0);
  EXPECT_LE(errors.rms(), 0.15);
}

TEST(DetectCharuco, SaysThatTheBoardIsAnother) {
  const Camera camera = PhoneCamera();
  const Rigid3 pose = LookAt(240, 15, 40, 5);
  const GrayImage photo = Photograph(Charuco(8, 6), camera, pose);
  const auto problem = [&](const Board& board) {
    const auto detection = DetectBoard(photo, board);
    EXPECT_TRUE(detection.mismatch) << detection.problem;
    EXPECT_TRUE(detection.corners.empty());
    return detection.problem;
  };
  EXPECT_NE(problem(Charuco(6, 8)).find("8 x 6 squares, not of 6 x 8"), std::string::npos);
  EXPECT_NE(problem(Charuco(9, 6)).find("9 x 6 squares"), std::string::npos);
  EXPECT_NE(problem(Charuco(5, 4)).find("ids up to 23"), std::string::npos);
  Board board = Charuco(8, 6);
  board.legacy_layout = true;
  EXPECT_NE(problem(board).find("legacy_layout = false"), std::string::npos);
  board = Charuco(8, 6);
  board.marker_mm = 10;
  EXPECT_NE(problem(board).find("marker_mm"), std::string::npos);
  board = Charuco(8, 6);
  board.dictionary = "DICT_6X6_250";
  const auto none = DetectBoard(photo, board);
  EXPECT_TRUE(none.corners.empty());
  EXPECT_NE(none.problem.find("DICT_6X6_250"), std::string::npos);
}

// On a board large enough that markers which do not fit still agree among themselves.
TEST(DetectCharuco, NamesTheFieldThatIsWrong) {
  const auto described = [](int columns, int rows) {
    Board board = Charuco(columns, rows);
    board.square_mm = 13;
    board.marker_mm = 9.75;
    board.dictionary = "DICT_5X5_1000";
    return board;
  };
  const Board truth = described(16, 12);
  const GrayImage photo = Photograph(truth, PhoneCamera(), LookAt(240, 15, 40, 5));
  ASSERT_EQ(DetectBoard(photo, truth).problem, "");
  const auto problem = [&](const Board& board) {
    const auto detection = DetectBoard(photo, board);
    EXPECT_TRUE(detection.corners.empty());
    return detection.problem;
  };
  EXPECT_THAT(problem(described(12, 16)), HasSubstr("a board of 16 x 12 squares, not of 12 x 16"));
  Board board = truth;
  board.marker_mm = 6.5;
  EXPECT_THAT(problem(board), HasSubstr("are about 0.7"));
  board = truth;
  board.dictionary = "DICT_4X4_1000";
  EXPECT_THAT(problem(board),
              AnyOf(HasSubstr("are of DICT_5X5_100 "), HasSubstr("(DICT_4X4_1000) seen")));
}

TEST(DetectBoard, FindsNothingInPicturesWithoutABoard) {
  testing::Random random(5);
  for (const auto& [width, height] : {std::pair{1, 1}, {40, 3000}, {640, 480}}) {
    GrayImage noise{width, height, std::vector<unsigned char>(static_cast<size_t>(width) * height)};
    for (auto& sample : noise.samples) {
      sample = static_cast<unsigned char>(random.Uniform(0, 255.99));
    }
    for (const Board& board : {Charuco(8, 6), Checkerboard(10, 7)}) {
      const auto detection = DetectBoard(noise, board);
      EXPECT_TRUE(detection.corners.empty());
      EXPECT_FALSE(detection.problem.empty());
    }
  }
}

}  // namespace
}  // namespace glint
