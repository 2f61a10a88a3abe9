#include <gtest/gtest.h>

#include <cmath>

#include "calib/corners/detector.h"
#include "tests/calib/corners/detection_errors.h"
#include "tests/calib/testing/synthetic_photo.h"

namespace glint {
namespace {

using testing::Checkerboard;
using testing::Errors;
using testing::LookAt;
using testing::PhoneCamera;
using testing::Photograph;
using testing::PhotoSettings;
using testing::Project;

TEST(DetectCheckerboard, FindsAllCornersOfAWholeBoardTheRightWayRound) {
  const Board board = Checkerboard(10, 7);
  const Camera camera = PhoneCamera();
  Errors all;
  for (int i = 0; i < 6; ++i) {
    const Rigid3 pose = LookAt(290 + 12 * i, 6 * i, 50 * i, 60 * i);
    const auto detection = DetectBoard(Photograph(board, camera, pose), board);
    EXPECT_TRUE(detection.position_known);
    EXPECT_EQ(detection.corners.size(), 54u) << "board " << i << ": " << detection.problem;
    Add(detection, camera, pose, &all);
  }
  EXPECT_EQ(all.wrong, 0);
  EXPECT_LE(all.bias(), 0.02);
  EXPECT_LE(all.rms(), 0.15);
}

TEST(DetectCheckerboard, UsesThePartThatIsSeen) {
  const Board board = Checkerboard(10, 7);
  const Camera camera = PhoneCamera();
  const Rigid3 pose = LookAt(290, 15, 40, 0);
  PhotoSettings settings;
  // A hand over the middle: the extent stays known.
  settings.cover = [](double x, double y) -> std::optional<double> {
    if (std::hypot(x - 20, y) < 25) return 0.4;
    return std::nullopt;
  };
  auto detection = DetectBoard(Photograph(board, camera, pose, settings), board);
  Errors errors;
  Add(detection, camera, pose, &errors);
  EXPECT_TRUE(detection.position_known) << detection.problem;
  EXPECT_GE(errors.corners, 42) << detection.problem;
  EXPECT_EQ(errors.wrong, 0);
  // Two columns hidden: which ones are missing cannot be told.
  settings.cover = [](double x, double) -> std::optional<double> {
    if (x > 52) return 0.4;
    return std::nullopt;
  };
  detection = DetectBoard(Photograph(board, camera, pose, settings), board);
  EXPECT_FALSE(detection.position_known);
  EXPECT_NE(detection.problem.find("only 7 x 6 of the 9 x 6"), std::string::npos)
      << detection.problem;
  EXPECT_EQ(detection.corners.size(), 42u);
}

// Action cameras bend the board's lines; 1280 × 960 as theirs.
TEST(DetectCheckerboard, FollowsLinesThatALensBends) {
  const Board board = Checkerboard(9, 7);
  Errors all;
  int inside = 0;
  for (const double k1 : {-0.1, -0.25, -0.3}) {
    const Camera camera{CameraModel::kSimpleRadial, 1280, 960, {1150, 637, 484, k1}};
    for (int i = 0; i < 6; ++i) {
      const double tilt_deg = 10 * i;
      const Rigid3 pose = LookAt(195 + 1.3 * tilt_deg, tilt_deg, 73 * i, 25 * i - 60);
      PhotoSettings settings;
      settings.seed = static_cast<std::uint64_t>(i + 1);
      settings.samples = 2;
      const auto detection = DetectBoard(Photograph(board, camera, pose, settings), board);
      EXPECT_TRUE(detection.position_known) << k1 << " " << i << ": " << detection.problem;
      Add(detection, camera, pose, &all);
      for (int row = 1; row < board.squares_y; ++row) {
        for (int column = 1; column < board.squares_x; ++column) {
          const Eigen::Vector2d point =
              Project(camera, pose, GridPointInSample(board, column, row));
          inside +=
              point.minCoeff() > 0 && point.x() < camera.width_px && point.y() < camera.height_px;
        }
      }
    }
  }
  EXPECT_EQ(all.wrong, 0);
  EXPECT_GE(all.corners, 0.95 * inside) << "of " << inside;
  EXPECT_LE(all.rms(), 0.15);
}

TEST(DetectCheckerboard, SaysThatTheBoardIsLarger) {
  const GrayImage photo = Photograph(Checkerboard(10, 7), PhoneCamera(), LookAt(290, 15, 40, 5));
  const auto detection = DetectBoard(photo, Checkerboard(8, 7));
  EXPECT_TRUE(detection.mismatch);
  EXPECT_NE(detection.problem.find("9 x 6 inner corners seen"), std::string::npos)
      << detection.problem;
}

}  // namespace
}  // namespace glint
