#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "calib/corners/chessboard_grid.h"
#include "calib/corners/detector_internal.h"

namespace glint::corners {
namespace {

constexpr double kRadiusSquares = 0.42;

using Cell = std::pair<int, int>;  // column, row of a grid with an origin of its own
using Grid = std::map<Cell, SaddleFit>;

std::vector<PlanePoint> Points(const Grid& grid) {
  std::vector<PlanePoint> points;
  for (const auto& [cell, fit] : grid) {
    points.push_back({Eigen::Vector2d(cell.first, cell.second), fit.centre_px});
  }
  return points;
}

// The detector's grid with columns to the right of rows (not mirrored): as seen from the front.
std::vector<std::pair<Cell, Eigen::Vector2d>> Unmirrored(const SeenGrid& seen) {
  const auto at = [&](int column, int row) { return seen.points_px[row * seen.columns + column]; };
  const Eigen::Vector2d right = at(1, 0) - at(0, 0), down = at(0, 1) - at(0, 0);
  const bool mirrored = right.x() * down.y() - right.y() * down.x() < 0;
  std::vector<std::pair<Cell, Eigen::Vector2d>> cells;
  for (int row = 0; row < seen.rows; ++row) {
    for (int column = 0; column < seen.columns; ++column) {
      cells.push_back({{mirrored ? seen.columns - 1 - column : column, row}, at(column, row)});
    }
  }
  return cells;
}

bool TopLeftIsBlack(const Cell& cell, bool origin_is_black) {
  return ((cell.first + cell.second) % 2 == 0) == origin_is_black;
}

// Fits the detector's corners for either colouring and keeps the one with more corners.
Grid FitSeen(const GrayImage& image, const SeenGrid& seen, const SaddleOptions& options,
             bool* origin_is_black) {
  const auto cells = Unmirrored(seen);
  std::vector<PlanePoint> points;
  for (const auto& [cell, point] : cells) {
    points.push_back({Eigen::Vector2d(cell.first, cell.second), point});
  }
  Grid best;
  for (const bool black : {true, false}) {
    Grid grid;
    for (const auto& [cell, point] : cells) {
      auto guess = GuessCorner(points, Eigen::Vector2d(cell.first, cell.second),
                               TopLeftIsBlack(cell, black), kRadiusSquares);
      if (!guess) continue;
      guess->centre_px = point;
      const SaddleFit fit = FitSaddle(image, *guess, options);
      if (fit.ok) grid[cell] = fit;
    }
    if (grid.size() > best.size()) {
      best = std::move(grid);
      *origin_is_black = black;
    }
  }
  return best;
}

void DropInconsistent(Grid* grid) {
  std::vector<Cell> cells;
  for (const auto& [cell, fit] : *grid) cells.push_back(cell);
  for (int index : Inconsistent(Points(*grid))) grid->erase(cells[index]);
}

// Looks for corners beside those known until there are no more. The limit lets the grid become
// larger than the description, which then is wrong.
void Grow(const GrayImage& image, const SaddleOptions& options, bool origin_is_black, int limit,
          Grid* grid) {
  std::map<Cell, int> tried;  // corners known when it was last tried
  for (bool grown = true; grown;) {
    grown = false;
    const auto points = Points(*grid);
    if (points.size() < 6) return;
    std::vector<Cell> candidates;
    for (const auto& [cell, fit] : *grid) {
      for (const auto& [dx, dy] : {Cell{1, 0}, Cell{-1, 0}, Cell{0, 1}, Cell{0, -1}}) {
        const Cell next{cell.first + dx, cell.second + dy};
        if (std::abs(next.first) > limit || std::abs(next.second) > limit) continue;
        if (grid->count(next) == 0) candidates.push_back(next);
      }
    }
    for (const Cell& next : candidates) {
      if (grid->count(next) || tried[next] >= 3) continue;
      ++tried[next];
      const auto guess = GuessCorner(points, Eigen::Vector2d(next.first, next.second),
                                     TopLeftIsBlack(next, origin_is_black), kRadiusSquares);
      if (!guess) continue;
      const SaddleFit fit = FitSaddle(image, *guess, options);
      if (!fit.ok) continue;
      (*grid)[next] = fit;
      grown = true;
    }
  }
}

struct Extent {
  int column0 = 0, row0 = 0, columns = 0, rows = 0;
};

Extent ExtentOf(const Grid& grid) {
  int c0 = 1 << 20, c1 = -c0, r0 = c0, r1 = -c0;
  for (const auto& [cell, fit] : grid) {
    c0 = std::min(c0, cell.first);
    c1 = std::max(c1, cell.first);
    r0 = std::min(r0, cell.second);
    r1 = std::max(r1, cell.second);
  }
  return {c0, r0, c1 - c0 + 1, r1 - r0 + 1};
}

// A quarter turn of grid coordinates inside an extent, k times clockwise.
Cell Turned(Cell cell, int turns, int columns, int rows) {
  for (int i = 0; i < turns; ++i) {
    cell = {rows - 1 - cell.second, cell.first};
    std::swap(columns, rows);
  }
  return cell;
}

// The grid's cells renumbered as the board's inner corners (0, 0) … : the turn for which the square
// at the top left is black, as described; among several, the one whose columns run most to the
// right.
std::map<Cell, SaddleFit> OnBoard(const Grid& grid, const Extent& extent, bool origin_is_black,
                                  int columns, int rows) {
  std::map<Cell, SaddleFit> best;
  double best_score = -1e9;
  for (int turns = 0; turns < 4; ++turns) {
    const int w = turns % 2 ? extent.rows : extent.columns;
    const int h = turns % 2 ? extent.columns : extent.rows;
    if (w > columns || h > rows) continue;
    std::map<Cell, SaddleFit> placed;
    bool black = false;  // of the square at the top left of corner (0, 0)
    for (const auto& [cell, fit] : grid) {
      const Cell local{cell.first - extent.column0, cell.second - extent.row0};
      const Cell there = Turned(local, turns, extent.columns, extent.rows);
      placed[there] = fit;
      // Seen along the turned diagonal, the corner's "top left" square is another of the four; a
      // quarter turn changes its colour.
      const bool top_left = TopLeftIsBlack(cell, origin_is_black) == (turns % 2 == 0);
      black = top_left == ((there.first + there.second) % 2 == 0);
    }
    Eigen::Vector2d right{0, 0};
    for (const auto& [cell, fit] : placed) {
      const auto next = placed.find({cell.first + 1, cell.second});
      if (next != placed.end()) right += (next->second.centre_px - fit.centre_px).normalized();
    }
    const double score = (black ? 10.0 : 0.0) + right.normalized().x();
    if (score > best_score) {
      best_score = score;
      best = std::move(placed);
    }
  }
  return best;
}

// Corners found, and whether the square at the top left of cell (0, 0) is black.
struct Seen {
  Grid grid;
  bool origin_is_black = true;
  bool grid_found = false;  // by a detector, sharp or not
};

using FindGrid = decltype(&FindChessboardGrid);

// What a detector takes for a grid is one when its corners look like corners; then with all corners
// that can be found beside them.
Seen SeenBy(FindGrid find, const GrayImage& image, int columns, int rows,
            const DetectorOptions& options) {
  Seen seen;
  const auto accept = [&](const SeenGrid& found) {
    seen.grid_found = true;
    seen.grid = FitSeen(image, found, options.saddle, &seen.origin_is_black);
    DropInconsistent(&seen.grid);
    return seen.grid.size() >= 6 && seen.grid.size() * 10 >= found.points_px.size() * 7;
  };
  if (!find(image, columns, rows, options.longest_px, accept)) {
    seen.grid.clear();
    return seen;
  }
  Grow(image, options.saddle, seen.origin_is_black, 2 * std::max(columns, rows) + 4, &seen.grid);
  DropInconsistent(&seen.grid);
  return seen;
}

bool IsSmaller(const Grid& grid, int columns, int rows) {
  if (grid.empty()) return true;
  const Extent extent = ExtentOf(grid);
  return std::max(extent.columns, extent.rows) < std::max(columns, rows) ||
         std::min(extent.columns, extent.rows) < std::min(columns, rows);
}

}  // namespace

BoardDetection DetectCheckerboard(const GrayImage& image, const Board& board,
                                  const DetectorOptions& options) {
  BoardDetection detection;
  const int columns = board.squares_x - 1, rows = board.squares_y - 1;
  Seen seen = SeenBy(FindChessboardGrid, image, columns, rows, options);
  if (IsSmaller(seen.grid, columns, rows)) {
    Seen second = SeenBy(FindChessboardByQuads, image, columns, rows, options);
    second.grid_found |= seen.grid_found;
    if (second.grid.size() >= seen.grid.size()) seen = std::move(second);
  }
  const Grid& grid = seen.grid;
  if (grid.empty()) {
    detection.problem = seen.grid_found ? "no part of a checkerboard sharp enough to be used"
                                        : "no checkerboard seen";
    return detection;
  }
  if (static_cast<int>(grid.size()) < options.min_corners) {
    detection.problem =
        fmt::format("a checkerboard, but only {} corners sharp enough to be used", grid.size());
    return detection;
  }
  const Extent extent = ExtentOf(grid);
  const int longer = std::max(extent.columns, extent.rows);
  const int shorter = std::min(extent.columns, extent.rows);
  if (longer > std::max(columns, rows) || shorter > std::min(columns, rows)) {
    detection.mismatch = true;
    detection.problem = fmt::format(
        "{} x {} inner corners seen, more than the {} x {} described; correct inner_corners (or "
        "squares) in [board]",
        longer, shorter, columns, rows);
    return detection;
  }
  detection.position_known =
      longer == std::max(columns, rows) && shorter == std::min(columns, rows);
  if (!detection.position_known) {
    detection.problem = fmt::format(
        "only {} x {} of the {} x {} inner corners seen, so their position on the board is "
        "unknown",
        longer, shorter, columns, rows);
  }
  for (const auto& [cell, fit] : OnBoard(grid, extent, seen.origin_is_black, columns, rows)) {
    const auto [column, row] = cell;
    detection.corners.push_back({row * columns + column,
                                 GridPointInSample(board, column + 1, row + 1), fit.centre_px,
                                 fit.sigma_px, fit.blur_px});
  }
  std::sort(detection.corners.begin(), detection.corners.end(),
            [](const CornerObservation& a, const CornerObservation& b) { return a.id < b.id; });
  return detection;
}

}  // namespace glint::corners
