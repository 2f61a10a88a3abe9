// Shared by the detectors; not for other folders.
#pragma once

#include <optional>
#include <vector>

#include "calib/corners/detector.h"
#include "calib/corners/local_homography.h"

namespace glint::corners {

// Neighbourhood, in squares, over which one homography follows the picture.
inline constexpr double kReachSquares = 1.5;

BoardDetection DetectCharuco(const GrayImage& image, const Board& board,
                             const DetectorOptions& options);
BoardDetection DetectMarkerFrame(const GrayImage& image, const Board& board,
                                 const DetectorOptions& options);
BoardDetection DetectCheckerboard(const GrayImage& image, const Board& board,
                                  const DetectorOptions& options);

// Where the corner at grid point `at` should be and how its squares lie, from points round it.
std::optional<SaddleGuess> GuessCorner(const std::vector<PlanePoint>& points,
                                       const Eigen::Vector2d& at, bool top_left_is_black,
                                       double radius_squares);

// Indices of points that do not go with their neighbours: each is predicted from all others, and
// the worst is taken away until none is off by more than max(1.5 px, 6 % of a square). Lens
// distortion at the rim of a board takes up to 4 %.
std::vector<int> Inconsistent(const std::vector<PlanePoint>& points);

}  // namespace glint::corners
