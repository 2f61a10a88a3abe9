#include <fmt/format.h>

#include <algorithm>
#include <string>

#include "base/board/dictionary.h"
#include "calib/corners/detector_internal.h"
#include "calib/corners/marker_match.h"

namespace glint::corners {
namespace {

constexpr size_t kMostListed = 12;

// "3, 5, 6 and 4 more"
std::string Listed(const std::vector<int>& ids) {
  std::string text;
  for (size_t i = 0; i < std::min(kMostListed, ids.size()); ++i) {
    text += (text.empty() ? "" : ", ") + std::to_string(ids[i]);
  }
  if (ids.size() > kMostListed) text += fmt::format(" and {} more", ids.size() - kMostListed);
  return text;
}

std::vector<int> IdsOf(const Board& board) {
  std::vector<int> ids;
  for (const ListedMarker& marker : board.markers) ids.push_back(marker.id);
  std::sort(ids.begin(), ids.end());
  return ids;
}

// Ids seen that the board does not have.
std::vector<int> Foreign(const std::vector<int>& on_board, const std::vector<SeenMarker>& seen) {
  std::vector<int> ids;
  for (const SeenMarker& marker : seen) {
    if (!std::binary_search(on_board.begin(), on_board.end(), marker.id)) ids.push_back(marker.id);
  }
  return ids;
}

// What contradicts the description; "" when nothing does.
std::string Contradiction(const Board& board, const std::vector<SeenMarker>& seen, size_t matched,
                          size_t agreeing) {
  const auto on_board = IdsOf(board);
  const auto foreign = Foreign(on_board, seen);
  if (foreign.size() >= 3 && foreign.size() > matched) {
    return fmt::format(
        "markers {} of {} seen, while board.json has {}; name the board that was photographed",
        Listed(foreign), board.dictionary, Listed(on_board));
  }
  // Lens distortion costs few markers.
  if (matched >= 4 && agreeing * 10 < matched * 7) {
    return fmt::format(
        "{} markers of the board seen, but only {} of them lie where board.json has them; correct "
        "their positions there",
        matched, agreeing);
  }
  return "";
}

struct FoundMarkers {
  std::vector<CornerObservation> corners;
  std::vector<PlanePoint> points;
};

FoundMarkers FitMarkers(const GrayImage& image, const Board& board, const DetectorOptions& options,
                        const std::vector<MarkerMatch>& matches) {
  const int cells = CellsOfMarker(board.dictionary, matches[0].id).cells;
  FoundMarkers found;
  for (const MarkerMatch& match : matches) {
    Eigen::Vector2d guess_px[4];
    for (int k = 0; k < 4; ++k) guess_px[k] = match.corners[k].image_px;
    const OutlineFit fit = FitOutline(image, guess_px, cells, options.outline);
    if (!fit.ok) continue;
    for (int k = 0; k < 4; ++k) {
      const Eigen::Vector2d on_board = match.corners[k].board * board.square_mm;
      found.corners.push_back(
          {4 * match.id + k,
           board.board_centre_in_sample_mm + Eigen::Vector2d(on_board.x(), -on_board.y()),
           fit.corners_px[k], fit.sigma_px[k]});
      found.points.push_back({match.corners[k].board, fit.corners_px[k]});
    }
  }
  return found;
}

}  // namespace

BoardDetection DetectMarkerFrame(const GrayImage& image, const Board& board,
                                 const DetectorOptions& options) {
  BoardDetection detection;
  const int on_board = static_cast<int>(board.markers.size());
  const auto seen = FindMarkers(image, board.dictionary, options.longest_px, (on_board + 1) / 2);
  const auto matches = MatchMarkers(board, seen);
  const auto agreeing = ConsensusOfFrame(board, seen);
  detection.markers = static_cast<int>(agreeing.size());
  detection.problem = Contradiction(board, seen, matches.size(), agreeing.size());
  detection.mismatch = !detection.problem.empty();
  if (detection.mismatch) return detection;
  if (agreeing.size() < 2) {
    detection.mismatch = options.explain_mismatch && ShowsMirroredMarkers(image, board, options);
    detection.problem = detection.mismatch
                            ? kMirrored
                            : fmt::format("{} of the board's {} markers ({}) seen", matches.size(),
                                          on_board, board.dictionary);
    return detection;
  }
  const FoundMarkers found = FitMarkers(image, board, options, agreeing);
  auto removed = Inconsistent(found.points);
  std::sort(removed.begin(), removed.end());
  for (int i = 0; i < static_cast<int>(found.corners.size()); ++i) {
    if (std::binary_search(removed.begin(), removed.end(), i)) continue;
    detection.corners.push_back(found.corners[i]);
  }
  if (static_cast<int>(detection.corners.size()) < options.min_corners) {
    detection.problem = fmt::format("{} markers but only {} corners sharp enough to be used",
                                    agreeing.size(), detection.corners.size());
    detection.corners.clear();
  }
  return detection;
}

}  // namespace glint::corners
