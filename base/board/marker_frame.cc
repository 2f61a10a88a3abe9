#include "base/board/marker_frame.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "base/board/dictionary.h"
#include "base/board/wrong_field.h"

namespace glint {
namespace {

constexpr size_t kMostMarkers = 1000;  // keeps memory bounded whatever a description says
constexpr double kMost_mm = 1e5;

double Cross(const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  return a.x() * b.y() - a.y() * b.x();
}

std::string CheckCorners(const ListedMarker& marker, const std::string& field) {
  double shortest = 1e300, longest = 0;
  int clockwise = 0, counter = 0;
  for (int k = 0; k < 4; ++k) {
    const Eigen::Vector2d& a = marker.corners_in_board_mm[k];
    const Eigen::Vector2d& b = marker.corners_in_board_mm[(k + 1) % 4];
    const Eigen::Vector2d& c = marker.corners_in_board_mm[(k + 2) % 4];
    if (!a.allFinite() || !(a.cwiseAbs().maxCoeff() < kMost_mm)) {
      return WrongField(field, "a corner out of range", "give millimetres below 100000");
    }
    shortest = std::min(shortest, (b - a).norm());
    longest = std::max(longest, (b - a).norm());
    (Cross(b - a, c - b) < 0 ? clockwise : counter) += 1;
  }
  if (counter == 4) {
    return WrongField(field, "corners listed anticlockwise",
                      "list them clockwise as seen from the front, from the marker's own top left "
                      "(y points up; AprilTag's own program lists them the other way round)");
  }
  if (clockwise != 4 || !(shortest > 0.05 * longest)) {
    return WrongField(field, "corners that do not form a square",
                      "list the four corners in turn, clockwise from the marker's own top left");
  }
  return "";
}

bool Inside(const BoardRectangle& r, const Eigen::Vector2d& p) {
  return p.x() > r.left_mm && p.x() < r.right_mm && p.y() > r.bottom_mm && p.y() < r.top_mm;
}

std::string CheckOpening(const Board& board) {
  const BoardRectangle& r = *board.opening_in_board;
  const std::string found =
      fmt::format("[{}, {}, {}, {}]", r.left_mm, r.bottom_mm, r.right_mm, r.top_mm);
  if (!(r.left_mm < r.right_mm) || !(r.bottom_mm < r.top_mm)) {
    return WrongField("opening_mm", found, "give [left, bottom, right, top] in millimetres");
  }
  for (const ListedMarker& marker : board.markers) {
    for (const Eigen::Vector2d& corner : marker.corners_in_board_mm) {
      if (!Inside(r, corner)) continue;
      return WrongField(
          "opening_mm", found,
          fmt::format("marker {} lies in it; give the hole in which the sample lies", marker.id));
    }
  }
  return "";
}

}  // namespace

std::string CheckMarkerFrame(const Board& board) {
  if (!DictionaryNumber(board.dictionary)) {
    return WrongField("dictionary", "\"" + board.dictionary + "\"",
                      fmt::format("use tag16h5, tag25h9, tag36h10, tag36h11 or one of {}",
                                  fmt::join(DictionaryNames(), ", ")));
  }
  if (board.markers.size() < 2 || board.markers.size() > kMostMarkers) {
    return WrongField("markers", fmt::format("{} of them", board.markers.size()),
                      fmt::format("list 2 to {}", kMostMarkers));
  }
  const int size = DictionarySize(board.dictionary);
  std::set<int> ids;
  for (size_t i = 0; i < board.markers.size(); ++i) {
    const ListedMarker& marker = board.markers[i];
    const std::string field = fmt::format("markers[{}]", i);
    if (marker.id < 0 || marker.id >= size) {
      return WrongField(field + ".id", std::to_string(marker.id),
                        fmt::format("{} has ids from 0 to {}", board.dictionary, size - 1));
    }
    if (!ids.insert(marker.id).second) {
      return WrongField(field + ".id", fmt::format("{} a second time", marker.id),
                        "each marker of a board needs an id of its own");
    }
    if (const std::string wrong = CheckCorners(marker, field); !wrong.empty()) return wrong;
  }
  return board.opening_in_board ? CheckOpening(board) : "";
}

}  // namespace glint
