#include "calib/corners/marker_match.h"

#include <algorithm>
#include <map>
#include <utility>

namespace glint::corners {
namespace {

std::vector<MarkerMatch> Agreeing(const std::vector<MarkerMatch>& matches,
                                  const Eigen::Matrix3d& h) {
  constexpr double kTolerance = 0.6;  // of a marker's side: lens distortion counts against it
  std::vector<MarkerMatch> agreeing;
  for (const MarkerMatch& match : matches) {
    bool fits = true;
    for (const PlanePoint& corner : match.corners) {
      const auto there = ApplyHomography(h, corner.board);
      fits = fits && there && (*there - corner.image_px).norm() < kTolerance * match.side_px;
    }
    if (fits) agreeing.push_back(match);
  }
  return agreeing;
}

}  // namespace

std::vector<MarkerMatch> MatchMarkers(const Board& board, const std::vector<SeenMarker>& seen) {
  std::map<int, BoardMarker> on_board;
  for (const BoardMarker& marker : BoardMarkers(board)) on_board[marker.id] = marker;
  std::vector<MarkerMatch> matches;
  for (const SeenMarker& marker : seen) {
    const auto found = on_board.find(marker.id);
    if (found == on_board.end()) continue;
    MarkerMatch match;
    match.id = marker.id;
    match.side_px = marker.side_px();
    for (int k = 0; k < 4; ++k) {
      match.corners[k] = {SquaresFromSample(board, found->second.corners_in_sample_mm[k]),
                          marker.corners_px[k]};
    }
    matches.push_back(match);
  }
  return matches;
}

std::vector<PlanePoint> MatchedPoints(const std::vector<MarkerMatch>& matches) {
  std::vector<PlanePoint> points;
  for (const MarkerMatch& match : matches)
    points.insert(points.end(), match.corners, match.corners + 4);
  return points;
}

std::vector<MarkerMatch> Consensus(const std::vector<MarkerMatch>& matches) {
  constexpr size_t kMaxPairs = 600;
  std::vector<MarkerMatch> best;
  const size_t n = matches.size();
  if (n < 2) return best;
  const size_t pairs = n * (n - 1) / 2;
  const size_t stride = std::max<size_t>(1, pairs / kMaxPairs);
  size_t number = 0;
  for (size_t gap = n - 1; gap >= 1; --gap) {
    for (size_t i = 0; i + gap < n; ++i) {
      if (number++ % stride != 0) continue;
      const auto h = FitHomography(MatchedPoints({matches[i], matches[i + gap]}));
      if (!h) continue;
      auto agreeing = Agreeing(matches, *h);
      if (agreeing.size() > best.size()) best = std::move(agreeing);
    }
  }
  if (best.size() < 2) return {};
  if (const auto h = FitHomography(MatchedPoints(best))) {
    auto again = Agreeing(matches, *h);
    if (again.size() > best.size()) best = std::move(again);
  }
  return best;
}

std::vector<MarkerMatch> ConsensusOfFrame(const Board& board, const std::vector<SeenMarker>& seen) {
  std::vector<MarkerMatch> best;
  for (int turn = 0; turn < 4; ++turn) {
    std::vector<SeenMarker> turned = seen;
    for (size_t i = 0; i < seen.size(); ++i) {
      for (int k = 0; k < 4; ++k) turned[i].corners_px[k] = seen[i].corners_px[(k + turn) % 4];
    }
    auto agreeing = Consensus(MatchMarkers(board, turned));
    if (agreeing.size() > best.size()) best = std::move(agreeing);
  }
  return best;
}

bool ShowsMirroredMarkers(const GrayImage& image, const Board& board,
                          const DetectorOptions& options) {
  GrayImage mirrored = image;
  for (int row = 0; row < image.height; ++row) {
    const auto begin = mirrored.samples.begin() + static_cast<std::ptrdiff_t>(row) * image.width;
    std::reverse(begin, begin + image.width);
  }
  const auto seen = FindMarkers(mirrored, board.dictionary, options.longest_px, 0);
  const auto agreeing = board.kind == BoardKind::kMarkers ? ConsensusOfFrame(board, seen)
                                                          : Consensus(MatchMarkers(board, seen));
  return agreeing.size() >= 3;
}

}  // namespace glint::corners
