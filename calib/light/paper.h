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

// One sample per spot that is seen large enough. Spots with a clipped pixel are left out, as are
// those farther than a square from a corner that was found (they may be covered).
std::vector<PaperSample> SamplePaper(const Photo& photo, Encoding encoding, const Board& board,
                                     const std::vector<PaperSpot>& spots,
                                     const std::vector<CornerObservation>& corners);

}  // namespace glint
