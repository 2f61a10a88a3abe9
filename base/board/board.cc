#include "base/board/board.h"

#include <utility>

#include "base/board/board_kind.h"
#include "base/board/wrong_field.h"

namespace glint {
namespace {

void Scale(double factor, BoardRectangle* r) {
  r->left_mm *= factor;
  r->bottom_mm *= factor;
  r->right_mm *= factor;
  r->top_mm *= factor;
}

bool Inside(const BoardRectangle& r, double x_mm, double y_mm) {
  return x_mm >= r.left_mm && x_mm <= r.right_mm && y_mm >= r.bottom_mm && y_mm <= r.top_mm;
}

}  // namespace

std::string CheckBoard(const Board& board) {
  if (!board.board_centre_in_sample_mm.allFinite()) {
    return WrongField("centre_mm", "a value that is not finite", "give two numbers in millimetres");
  }
  return KindOf(board.kind).Check(board);
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

Eigen::Vector2d SquaresFromSample(const Board& board,
                                  const Eigen::Vector2d& position_in_sample_mm) {
  const Eigen::Vector2d offset =
      (position_in_sample_mm - board.board_centre_in_sample_mm) / board.square_mm;
  return {0.5 * board.squares_x + offset.x(), 0.5 * board.squares_y - offset.y()};
}

BoardRectangle OutlineInSample(const Board& board) { return KindOf(board.kind).Outline(board); }

std::optional<BoardRectangle> OpeningInSample(const Board& board) {
  return KindOf(board.kind).Opening(board);
}

bool LooksTheSameUpsideDown(const Board& board) {
  return KindOf(board.kind).LooksTheSameUpsideDown(board);
}

std::vector<BoardCorner> BoardCorners(const Board& board) {
  return KindOf(board.kind).Corners(board);
}

std::vector<BoardMarker> BoardMarkers(const Board& board) {
  return KindOf(board.kind).Markers(board);
}

std::vector<PaperSpot> PaperSpots(const Board& board) { return KindOf(board.kind).Paper(board); }

std::string BoardInWords(const Board& board) { return KindOf(board.kind).InWords(board); }

BoardPainter::BoardPainter(const Board& board, double margin_mm)
    : board_(board), sheet_(OutlineInSample(board)), ink_(KindOf(board.kind).Ink(board)) {
  sheet_ = {sheet_.left_mm - margin_mm, sheet_.bottom_mm - margin_mm, sheet_.right_mm + margin_mm,
            sheet_.top_mm + margin_mm};
}

std::optional<double> BoardPainter::ReflectanceAt(double x_mm, double y_mm) const {
  for (const BoardPatch& patch : board_.patches) {
    if (Inside(InSample(board_, patch.in_board), x_mm, y_mm)) return patch.reflectance;
  }
  if (!Inside(sheet_, x_mm, y_mm)) return std::nullopt;
  return ink_->ReflectanceAt({x_mm, y_mm});
}

}  // namespace glint
