// Boards, a camera and error counts that the detector's tests share.
#pragma once

#include <cmath>

#include "calib/corners/detector.h"
#include "tests/calib/testing/synthetic_photo.h"

namespace glint::testing {

inline Board Charuco(int x, int y) {
  Board board;
  board.squares_x = x;
  board.squares_y = y;
  board.square_mm = 20;
  board.marker_mm = 14;
  board.dictionary = "DICT_5X5_100";
  return board;
}

inline Board Checkerboard(int x, int y) {
  Board board = Charuco(x, y);
  board.kind = BoardKind::kCheckerboard;
  return board;
}

inline Camera PhoneCamera() {
  return {CameraModel::kRadial, 800, 600, {720, 404.3, 297.1, 0.06, -0.08}};
}

// Errors of the corners found, in the sense found − true.
struct Errors {
  int corners = 0, wrong = 0;
  Eigen::Vector2d sum{0, 0};
  double squares = 0;

  double bias() const { return sum.norm() / corners; }
  double rms() const { return std::sqrt(squares / corners); }
};

inline void Add(const BoardDetection& detection, const Camera& camera,
                const Rigid3& camera_from_sample, Errors* errors) {
  for (const CornerObservation& corner : detection.corners) {
    const Eigen::Vector2d error =
        corner.point_px - Project(camera, camera_from_sample, corner.position_in_sample_mm);
    ++errors->corners;
    errors->sum += error;
    errors->squares += error.squaredNorm();
    errors->wrong += error.norm() > 0.5;
  }
}

}  // namespace glint::testing
