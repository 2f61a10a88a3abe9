// The board's white paper in a photograph: a reflector of roughly known albedo at known places.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "calib/board/board.h"
#include "calib/corners/detector.h"
#include "pipeline/contract/image.h"
#include "rectify/linearize/encoding.h"

namespace glint {

struct PaperSample {
  Eigen::Vector2d position_in_sample_mm;
  Eigen::Vector3d radiance;  // linear, R G B; the sensor clips at 1
};

// One sample per spot of plain paper that is seen large enough: the corners of a ChArUco board's
// white squares between marker and edge, the centres of a checkerboard's. Spots with a clipped
// pixel are left out, as are those farther than a square from a corner that was found (they may be
// covered).
std::vector<PaperSample> SamplePaper(const Photo& photo, Encoding encoding, const Board& board,
                                     const std::vector<CornerObservation>& corners);

}  // namespace glint
