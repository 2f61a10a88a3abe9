#include "calib/corners/charuco_mismatch.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "calib/corners/marker_match.h"

namespace glint::corners {
namespace {

// Whether most of what is seen lies where this description has it, and markedly more than before.
bool Explains(const Board& board, const std::vector<SeenMarker>& seen, size_t agreeing_before) {
  const std::vector<MarkerMatch> matches = MatchMarkers(board, seen);
  const size_t agreeing = Consensus(matches).size();
  return agreeing >= 6 && agreeing * 10 >= matches.size() * 7 &&
         agreeing > agreeing_before + seen.size() / 5;
}

// The side of a marker in squares with which most lie where they should, the middle one of those
// that explain as many; 0: none explains what is seen.
double ShareOfMarkers(Board board, const std::vector<SeenMarker>& seen, size_t agreeing_before) {
  size_t most = 0;
  std::vector<double> shares;
  for (int percent = 30; percent <= 95; percent += 5) {
    board.marker_mm = 0.01 * percent * board.square_mm;
    if (!Explains(board, seen, agreeing_before)) continue;
    const size_t agreeing = Consensus(MatchMarkers(board, seen)).size();
    if (agreeing > most) shares.clear();
    if (agreeing >= most) shares.push_back(0.01 * percent);
    most = std::max(most, agreeing);
  }
  return shares.empty() ? 0 : shares[shares.size() / 2];
}

}  // namespace

std::string ExplainMismatch(const GrayImage& image, const Board& board,
                            const DetectorOptions& options, const std::vector<SeenMarker>& seen,
                            size_t agreeing) {
  Board other = board;
  other.legacy_layout = !board.legacy_layout;
  if (board.squares_y % 2 == 0 && Explains(other, seen, agreeing)) {
    return fmt::format("the markers lie as on a board with legacy_layout = {}; set it in [board]",
                       other.legacy_layout);
  }
  other = board;
  other.window.reset();  // which was described for the other shape
  std::swap(other.squares_x, other.squares_y);
  if (board.squares_x != board.squares_y && Explains(other, seen, agreeing)) {
    return fmt::format(
        "the markers lie as on a board of {} x {} squares, not of {} x {}; swap the two numbers of "
        "squares, and check window, in [board]",
        other.squares_x, other.squares_y, board.squares_x, board.squares_y);
  }
  if (const double share = ShareOfMarkers(board, seen, agreeing); share > 0) {
    return fmt::format(
        "the markers' sides are about {:.2f} times a square's side, not {:.2f}; "
        "measure both, and correct marker_mm or square_mm in [board]",
        share, board.marker_mm / board.square_mm);
  }
  int markers = 0;
  other = board;
  other.dictionary = GuessDictionary(image, options.longest_px, &markers);
  if (other.dictionary.empty() || other.dictionary == board.dictionary) return "";
  const auto seen_then = FindMarkers(image, other.dictionary, options.longest_px, markers);
  if (!Explains(other, seen_then, agreeing)) return "";
  return fmt::format(
      "its {} markers are of {} or of a larger dictionary of that family, not of {}; correct "
      "dictionary in [board]",
      seen_then.size(), other.dictionary, board.dictionary);
}

}  // namespace glint::corners
