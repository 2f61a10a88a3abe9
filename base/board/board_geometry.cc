// Sizes and places of whole boards.
#include <algorithm>
#include <utility>

#include "base/board/board.h"

namespace glint {
namespace {

void Scale(double factor, BoardRectangle* r) {
  r->left_mm *= factor;
  r->bottom_mm *= factor;
  r->right_mm *= factor;
  r->top_mm *= factor;
}

}  // namespace

std::string BoardKindName(BoardKind kind) {
  switch (kind) {
    case BoardKind::kCharuco:
      return "charuco";
    case BoardKind::kCheckerboard:
      return "checkerboard";
    case BoardKind::kMarkers:
      break;
  }
  return "markers";
}

std::optional<BoardKind> BoardKindNamed(const std::string& name) {
  for (const BoardKind kind :
       {BoardKind::kCharuco, BoardKind::kCheckerboard, BoardKind::kMarkers}) {
    if (name == BoardKindName(kind)) return kind;
  }
  return std::nullopt;
}

Board MakeMarkerBoard(const std::string& dictionary, std::vector<ListedMarker> markers) {
  Board board;
  board.kind = BoardKind::kMarkers;
  board.dictionary = dictionary;
  double sides = 0;
  for (const ListedMarker& marker : markers) {
    for (int k = 0; k < 4; ++k) {
      sides += (marker.corners_in_board_mm[(k + 1) % 4] - marker.corners_in_board_mm[k]).norm();
    }
  }
  board.square_mm = markers.empty() ? 0 : sides / (4.0 * static_cast<double>(markers.size()));
  board.markers = std::move(markers);
  return board;
}

void ScaleBoard(double factor, Board* board) {
  board->square_mm *= factor;
  board->marker_mm *= factor;
  for (ListedMarker& marker : board->markers) {
    for (Eigen::Vector2d& corner : marker.corners_in_board_mm) corner *= factor;
  }
  if (board->opening_in_board) Scale(factor, &*board->opening_in_board);
  for (BoardPatch& patch : board->patches) Scale(factor, &patch.in_board);
  if (board->ruler) {
    board->ruler->from_in_board_mm *= factor;
    board->ruler->to_in_board_mm *= factor;
  }
  board->print_scale *= factor;
}

BoardRectangle InSample(const Board& board, const BoardRectangle& r) {
  const Eigen::Vector2d& centre = board.board_centre_in_sample_mm;
  return {r.left_mm + centre.x(), r.bottom_mm + centre.y(), r.right_mm + centre.x(),
          r.top_mm + centre.y()};
}

BoardRectangle OutlineInSample(const Board& board) {
  if (board.kind != BoardKind::kMarkers) {
    const Eigen::Vector2d low = GridPointInSample(board, 0, board.squares_y);
    const Eigen::Vector2d high = GridPointInSample(board, board.squares_x, 0);
    return {low.x(), low.y(), high.x(), high.y()};
  }
  Eigen::Vector2d low(1e300, 1e300), high = -low;
  for (const ListedMarker& marker : board.markers) {
    for (const Eigen::Vector2d& corner : marker.corners_in_board_mm) {
      low = low.cwiseMin(corner);
      high = high.cwiseMax(corner);
    }
  }
  return InSample(board, {low.x(), low.y(), high.x(), high.y()});
}

std::optional<BoardRectangle> OpeningInSample(const Board& board) {
  if (board.opening_in_board) return InSample(board, *board.opening_in_board);
  if (!board.window) return std::nullopt;
  const BoardWindow& w = *board.window;
  const Eigen::Vector2d low = GridPointInSample(board, w.first_column, w.first_row + w.rows);
  const Eigen::Vector2d high = GridPointInSample(board, w.first_column + w.columns, w.first_row);
  return BoardRectangle{low.x(), low.y(), high.x(), high.y()};
}

}  // namespace glint
