// OpenCV's checkerboard detectors behind our own types.
#pragma once

#include <Eigen/Core>
#include <functional>
#include <vector>

#include "calib/corners/gray_image.h"

namespace glint::corners {

// A whole grid of corners, row-major; which side is up and whether it is mirrored are not known.
struct SeenGrid {
  int columns = 0, rows = 0;
  std::vector<Eigen::Vector2d> points_px;
};

// Looks for grids, most likely ones first, until `accept` says that one is a checkerboard: one of
// exactly columns × rows inner corners; the largest that the detector can make out in the picture,
// and in overlapping parts of it, where something may hide the rest of the board; at last what
// OpenCV's older detector finds. False: none accepted.
bool FindChessboardGrid(const GrayImage& image, int columns, int rows, int longest_px,
                        const std::function<bool(const SeenGrid&)>& accept);

}  // namespace glint::corners
