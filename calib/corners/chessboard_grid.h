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

// Look for grids until `accept` says that one is a checkerboard; false: none accepted.
using AcceptGrid = std::function<bool(const SeenGrid&)>;

// Most likely ones first: one of exactly columns × rows inner corners; the largest that the
// detector (Duda and Frese 2018) can make out in the picture, and in overlapping parts of it, where
// something may hide the rest of the board.
bool FindChessboardGrid(const GrayImage& image, int columns, int rows, int longest_px,
                        const AcceptGrid& accept);

// A second opinion: OpenCV's older detector, which joins black quadrangles and so follows lines
// that a lens bends, and which finds whole boards of columns × rows inner corners only.
bool FindChessboardByQuads(const GrayImage& image, int columns, int rows, int longest_px,
                           const AcceptGrid& accept);

}  // namespace glint::corners
