// The board's white paper in a photograph: a reflector of roughly known albedo at known places.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "base/board/board.h"
#include "base/linearize/encoding.h"
#include "base/photos/photo.h"
#include "calib/corners/detector.h"

namespace glint {

struct PaperSample {
  Eigen::Vector2d position_in_sample_mm;
  Eigen::Vector3d radiance;  // linear, R G B; the sensor clips at 1
  int block = 0;             // of 3 × 3 squares, in which it lies
  int pixels = 1;            // of which `radiance` is the mean
  double ink_px = 100;       // distance of the nearest ink from the spot's middle
};

// A place of plain paper on the board.
struct PaperSpot {
  Eigen::Vector2d squares;    // board coordinates: column to the right, row down
  double radius_squares = 0;  // of plain paper
  int block = 0;              // of 3 × 3 squares, in which it lies
};

// The places of the board that are farthest from ink, window and border, the largest first: discs
// of plain paper whose centres keep a radius from each other. The larger the disc, the less of the
// ink's blur and of JPEG's blocks reaches its middle. Discs of less than 0.45 of the largest radius
// are left out. Of a marker frame: the rims of its markers, a block each. paper_spots.cc.
std::vector<PaperSpot> PaperSpots(const Board& board);

// One sample per spot that is seen large enough. Spots with a clipped pixel are left out, as are
// those farther than a square from a corner that was found (they may be covered).
std::vector<PaperSample> SamplePaper(const Photo& photo, Encoding encoding, const Board& board,
                                     const std::vector<PaperSpot>& spots,
                                     const std::vector<CornerObservation>& corners);

}  // namespace glint
