#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "calib/corners/charuco_mismatch.h"
#include "calib/corners/detector_internal.h"
#include "calib/corners/marker_match.h"

namespace glint::corners {
namespace {

// The radius round a corner that no marker's ink reaches.
double FreeRadiusSquares(const Board& board) {
  const double gap = 0.5 * (1.0 - board.marker_mm / board.square_mm);
  return std::min(0.42, 0.92 * std::sqrt(2.0) * gap);
}

struct FoundCorner {
  CornerObservation observation;
  PlanePoint point;
};

// Fits every corner that is not found yet; returns how many came new.
int FindCorners(const GrayImage& image, const Board& board, const DetectorOptions& options,
                const std::vector<PlanePoint>& points, std::map<int, FoundCorner>* found) {
  int added = 0;
  for (const BoardCorner& corner : BoardCorners(board)) {
    if (found->count(corner.id)) continue;
    const Eigen::Vector2d at = SquaresFromSample(board, corner.position_in_sample_mm);
    const int column = static_cast<int>(std::lround(at.x()));
    const int row = static_cast<int>(std::lround(at.y()));
    const auto guess = GuessCorner(points, at, SquareIsBlack(board, column - 1, row - 1),
                                   FreeRadiusSquares(board));
    if (!guess) continue;
    const SaddleFit fit = FitSaddle(image, *guess, options.saddle);
    if (!fit.ok) continue;
    (*found)[corner.id] = {
        {corner.id, corner.position_in_sample_mm, fit.centre_px, fit.sigma_px, fit.blur_px},
        {at, fit.centre_px}};
    ++added;
  }
  return added;
}

void DropInconsistent(std::map<int, FoundCorner>* found) {
  std::vector<PlanePoint> points;
  std::vector<int> ids;
  for (const auto& [id, one] : *found) {
    points.push_back(one.point);
    ids.push_back(id);
  }
  for (int index : Inconsistent(points)) found->erase(ids[index]);
}

// Median of seen over described size of the markers, given where the corners are; 0: unknown.
double MarkerScale(const std::vector<MarkerMatch>& matches,
                   const std::map<int, FoundCorner>& found) {
  std::vector<PlanePoint> points;
  for (const auto& [id, one] : found) points.push_back(one.point);
  std::vector<double> ratios;
  for (const MarkerMatch& match : matches) {
    // Markers among corners only: a homography tells little of what lies far from its points.
    const Eigen::Vector2d at = 0.5 * (match.corners[0].board + match.corners[2].board);
    const auto near = std::count_if(points.begin(), points.end(), [&](const PlanePoint& point) {
      return (point.board - at).norm() < 1.7;
    });
    const auto h = LocalHomography(points, at, kReachSquares);
    if (near < 4 || !h) continue;
    double side = 0;
    for (int k = 0; k < 4; ++k) {
      const auto a = ApplyHomography(*h, match.corners[k].board);
      const auto b = ApplyHomography(*h, match.corners[(k + 1) % 4].board);
      if (a && b) side += 0.25 * (*a - *b).norm();
    }
    if (side > 0) ratios.push_back(match.side_px / side);
  }
  if (ratios.size() < 4 || found.size() < 8) return 0;
  std::nth_element(ratios.begin(), ratios.begin() + ratios.size() / 2, ratios.end());
  return ratios[ratios.size() / 2];
}

BoardDetection Mismatch(BoardDetection detection, const std::string& problem) {
  detection.mismatch = true;
  detection.problem = problem;
  detection.corners.clear();
  return detection;
}

}  // namespace

BoardDetection DetectCharuco(const GrayImage& image, const Board& board,
                             const DetectorOptions& options) {
  BoardDetection detection;
  const int on_board = static_cast<int>(BoardMarkers(board).size());
  const auto seen = FindMarkers(image, board.dictionary, options.longest_px, (on_board + 1) / 2);
  const auto matches = MatchMarkers(board, seen);
  const auto agreeing = Consensus(matches);
  detection.markers = static_cast<int>(agreeing.size());
  // By the field that is wrong, if one explains what is seen.
  const auto mismatch = [&](const std::string& otherwise) {
    if (!options.explain_mismatch) return Mismatch(detection, otherwise);
    const std::string why = ExplainMismatch(image, board, options, seen, agreeing.size());
    return Mismatch(detection, why.empty() ? otherwise : why);
  };
  const int all_ids = board.squares_x * board.squares_y / 2;  // the window's included
  const auto foreign =
      std::count_if(seen.begin(), seen.end(), [&](const SeenMarker& m) { return m.id >= all_ids; });
  if (foreign >= 4 && foreign * 4 > static_cast<long>(seen.size())) {
    return mismatch(
        fmt::format("markers with ids up to {} seen, while {} x {} squares have {}; "
                    "correct squares in [board]",
                    seen.back().id, board.squares_x, board.squares_y, all_ids));
  }
  // Lens distortion costs few markers; a wrong layout costs a third at least.
  if (matches.size() >= 6 && agreeing.size() * 10 < matches.size() * 7) {
    return mismatch(
        fmt::format("{} markers of {} seen (ids {} to {}), but only {} of {} lie where a board of "
                    "{} x {} squares has them; correct squares in [board]",
                    seen.size(), board.dictionary, seen.front().id, seen.back().id, agreeing.size(),
                    matches.size(), board.squares_x, board.squares_y));
  }
  if (agreeing.size() < 2) {
    if (options.explain_mismatch && ShowsMirroredMarkers(image, board, options)) {
      return Mismatch(detection, kMirrored);
    }
    detection.problem = fmt::format("{} of the board's {} markers ({}) seen", matches.size(),
                                    on_board, board.dictionary);
    return detection;
  }
  std::map<int, FoundCorner> found;
  FindCorners(image, board, options, MatchedPoints(agreeing), &found);
  DropInconsistent(&found);
  // Corners predict their neighbours better than markers do.
  for (int round = 0; round < 3 && found.size() >= 6; ++round) {
    std::vector<PlanePoint> points;
    for (const auto& [id, one] : found) points.push_back(one.point);
    if (FindCorners(image, board, options, points, &found) == 0) break;
    DropInconsistent(&found);
  }
  const double scale = MarkerScale(agreeing, found);
  if (scale > 0 && std::abs(scale - 1) > 0.12) {
    return Mismatch(
        detection,
        fmt::format("the markers' sides are {:.2f} times a square's side, not {:.2f}; correct "
                    "marker_mm or square_mm in [board]",
                    scale * board.marker_mm / board.square_mm, board.marker_mm / board.square_mm));
  }
  if (static_cast<int>(found.size()) < options.min_corners) {
    detection.problem = fmt::format("{} markers but only {} corners sharp enough to be used",
                                    agreeing.size(), found.size());
    return detection;
  }
  for (const auto& [id, one] : found) detection.corners.push_back(one.observation);
  return detection;
}

}  // namespace glint::corners
