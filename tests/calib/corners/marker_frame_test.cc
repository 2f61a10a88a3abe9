// Frames of single markers: their corners in pictures made from the description.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>

#include "tests/calib/corners/detection_errors.h"
#include "tests/calib/testing/synthetic_photo.h"

namespace glint {
namespace {

using testing::Errors;
using ::testing::HasSubstr;
using testing::LookAt;
using testing::Photograph;
using testing::PhotoSettings;
using testing::Project;

// Sixteen AprilTags round a window, as MaterialGAN's users print them: sides of 20 mm, 40 mm apart.
Board TagFrame(int first_id = 0) {
  std::vector<ListedMarker> markers;
  for (int row = 0; row < 5; ++row) {
    for (int column = 0; column < 5; ++column) {
      if (row % 4 != 0 && column % 4 != 0) continue;
      ListedMarker marker;
      marker.id = first_id + static_cast<int>(markers.size());
      const Eigen::Vector2d centre(40.0 * (column - 2), 40.0 * (2 - row));
      marker.corners_in_board_mm[0] = centre + Eigen::Vector2d(-10, 10);
      marker.corners_in_board_mm[1] = centre + Eigen::Vector2d(10, 10);
      marker.corners_in_board_mm[2] = centre + Eigen::Vector2d(10, -10);
      marker.corners_in_board_mm[3] = centre + Eigen::Vector2d(-10, -10);
      markers.push_back(marker);
    }
  }
  Board board = MakeMarkerBoard("DICT_APRILTAG_36h11", markers);
  board.opening_in_board = BoardRectangle{-60, -60, 60, 60};
  return board;
}

// A phone's picture, with the lens' distortion of detection_errors.h.
const Camera kCamera{CameraModel::kRadial, 1200, 900, {1080, 604.3, 446.1, 0.06, -0.08}};

TEST(DetectMarkerFrame, HasNoBiasUnderPerspectiveBlurAndNoise) {
  const Board board = TagFrame();
  ASSERT_EQ(CheckBoard(board), "");
  Errors all;
  Eigen::Vector2d outward(0, 0);  // along the marker's diagonals: that they seem too large
  for (int i = 0; i < 5; ++i) {
    const Rigid3 pose = LookAt(300 + 15 * i, 4 + 8 * i, 60 * i, -40 + 17 * i, {3.0 * i - 8, 4});
    PhotoSettings settings;
    settings.blur_px = 0.5 + 0.2 * i;
    settings.seed = i;
    settings.samples = 2;
    const auto detection = DetectBoard(Photograph(board, kCamera, pose, settings), board);
    EXPECT_GE(detection.corners.size(), i < 4 ? 52u : 32u)
        << "picture " << i << ": " << detection.problem;
    Errors one;
    Add(detection, kCamera, pose, &one);
    Add(detection, kCamera, pose, &all);
    double growth = 0;
    for (const CornerObservation& corner : detection.corners) {
      const BoardMarker marker = BoardMarkers(board)[corner.id / 4];
      const Eigen::Vector2d centre =
          0.5 * (marker.corners_in_sample_mm[0] + marker.corners_in_sample_mm[2]);
      const Eigen::Vector2d truth = Project(kCamera, pose, corner.position_in_sample_mm);
      const Eigen::Vector2d away = (truth - Project(kCamera, pose, centre)).normalized();
      growth += away.dot(corner.point_px - truth) / static_cast<double>(detection.corners.size());
    }
    std::printf("picture %d: %d corners, bias %.4f px, RMS %.4f px, outward %.4f px\n", i,
                one.corners, one.bias(), one.rms(), growth);
    EXPECT_LE(std::abs(growth), 0.05);
  }
  std::printf("all: %d corners, bias %.4f px, RMS %.4f px\n", all.corners, all.bias(), all.rms());
  EXPECT_LE(all.bias(), 0.02);
  EXPECT_LE(all.rms(), 0.15);
  EXPECT_EQ(all.wrong, 0);
}

TEST(DetectMarkerFrame, StatesTheUncertaintyItHas) {
  const Board board = TagFrame();
  const Rigid3 pose = LookAt(330, 20, 40, 10);
  double squares = 0;
  int corners = 0;
  for (int seed = 0; seed < 2; ++seed) {
    PhotoSettings settings;
    settings.seed = 10 + seed;
    settings.noise = 4;
    settings.samples = 2;
    const auto detection = DetectBoard(Photograph(board, kCamera, pose, settings), board);
    for (const CornerObservation& c : detection.corners) {
      const Eigen::Vector2d error = c.point_px - Project(kCamera, pose, c.position_in_sample_mm);
      squares += 0.5 * error.squaredNorm() / (c.sigma_px * c.sigma_px);
      ++corners;
    }
  }
  ASSERT_GE(corners, 110);
  EXPECT_GT(std::sqrt(squares / corners), 0.6);
  EXPECT_LT(std::sqrt(squares / corners), 1.8);
}

TEST(DetectMarkerFrame, LeavesOutMarkersThatSomethingHides) {
  const Board board = TagFrame();
  PhotoSettings settings;
  settings.samples = 2;
  // A finger over the lower left, through markers.
  settings.cover = [](double x, double y) -> std::optional<double> {
    if (x + y < -95) return 0.35;
    return std::nullopt;
  };
  const Rigid3 pose = LookAt(330, 15, 200, 5);
  const auto detection = DetectBoard(Photograph(board, kCamera, pose, settings), board);
  Errors errors;
  Add(detection, kCamera, pose, &errors);
  EXPECT_GE(errors.corners, 36) << detection.problem;
  EXPECT_LE(errors.corners, 56);
  EXPECT_EQ(errors.wrong, 0);
}

// OpenCV's AprilTags are upside down to AprilTag's own: descriptions have either.
TEST(DetectMarkerFrame, UnderstandsMarkersThatAreAllTurnedAlike) {
  const Board board = TagFrame();
  const Rigid3 pose = LookAt(330, 15, 40, 5);
  PhotoSettings settings;
  settings.samples = 2;
  const GrayImage photo = Photograph(board, kCamera, pose, settings);
  for (int turn = 0; turn < 4; ++turn) {
    Board turned = board;
    for (size_t i = 0; i < board.markers.size(); ++i) {
      for (int k = 0; k < 4; ++k) {
        turned.markers[i].corners_in_board_mm[k] =
            board.markers[i].corners_in_board_mm[(k + turn) % 4];
      }
    }
    Errors errors;
    Add(DetectBoard(photo, turned), kCamera, pose, &errors);
    EXPECT_GE(errors.corners, 56) << turn;
    EXPECT_EQ(errors.wrong, 0) << turn;
  }
}

TEST(DetectMarkerFrame, SaysWhatWasSeenInstead) {
  const Rigid3 pose = LookAt(330, 15, 40, 5);
  PhotoSettings settings;
  settings.samples = 2;
  const GrayImage photo = Photograph(TagFrame(), kCamera, pose, settings);

  const auto other = DetectBoard(photo, TagFrame(100));
  EXPECT_TRUE(other.mismatch);
  EXPECT_THAT(other.problem, HasSubstr("markers 0, 1, 2"));
  EXPECT_THAT(other.problem, HasSubstr("board.json has 100, 101"));

  Board shuffled = TagFrame();
  for (size_t i = 0; i + 1 < shuffled.markers.size(); i += 2) {
    std::swap(shuffled.markers[i].id, shuffled.markers[i + 1].id);
  }
  const auto misplaced = DetectBoard(photo, shuffled);
  EXPECT_TRUE(misplaced.mismatch);
  EXPECT_THAT(misplaced.problem, HasSubstr("lie where board.json has them"));

  GrayImage mirrored = photo;
  for (int row = 0; row < photo.height; ++row) {
    std::reverse(mirrored.samples.begin() + row * photo.width,
                 mirrored.samples.begin() + (row + 1) * photo.width);
  }
  for (const Board& board : {TagFrame()}) {
    const auto detection = DetectBoard(mirrored, board);
    EXPECT_TRUE(detection.mismatch);
    EXPECT_THAT(detection.problem, HasSubstr("mirrored"));
  }
}

TEST(DetectCharuco, SaysThatThePictureIsMirrored) {
  const Board board = testing::Charuco(8, 6);
  PhotoSettings settings;
  settings.samples = 2;
  GrayImage photo = Photograph(board, testing::PhoneCamera(), LookAt(240, 15, 40, 5), settings);
  for (int row = 0; row < photo.height; ++row) {
    std::reverse(photo.samples.begin() + row * photo.width,
                 photo.samples.begin() + (row + 1) * photo.width);
  }
  const auto detection = DetectBoard(photo, board);
  EXPECT_TRUE(detection.mismatch);
  EXPECT_THAT(detection.problem, HasSubstr("mirrored"));
}

}  // namespace
}  // namespace glint
