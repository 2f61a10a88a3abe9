#include <cmath>

#include "calib/board/board.h"
#include "calib/board/dictionary.h"

namespace glint {

BoardPainter::BoardPainter(const Board& board, double margin_mm)
    : board_(board), margin_mm_(margin_mm) {
  if (board.kind != BoardKind::kCharuco) return;
  marker_bits_.resize(static_cast<size_t>(board.squares_x) * board.squares_y);
  int id = 0;
  for (int row = 0; row < board.squares_y; ++row) {
    for (int column = 0; column < board.squares_x; ++column) {
      if (SquareIsBlack(board, column, row)) continue;
      const int marker_id = id++;
      if (!SquareExists(board, column, row)) continue;
      MarkerCells marker = CellsOfMarker(board.dictionary, marker_id);
      marker_cells_ = marker.cells;
      marker_bits_[static_cast<size_t>(row) * board.squares_x + column] = std::move(marker.paper);
    }
  }
}

std::optional<double> BoardPainter::ReflectanceAt(double x_mm, double y_mm) const {
  // Squares from the board's top left corner; row grows downward.
  const double column_mm =
      x_mm - board_.board_centre_in_sample_mm.x() + 0.5 * board_.squares_x * board_.square_mm;
  const double row_mm =
      board_.board_centre_in_sample_mm.y() + 0.5 * board_.squares_y * board_.square_mm - y_mm;
  const double width_mm = board_.squares_x * board_.square_mm;
  const double height_mm = board_.squares_y * board_.square_mm;
  if (!(column_mm >= -margin_mm_ && column_mm <= width_mm + margin_mm_ && row_mm >= -margin_mm_ &&
        row_mm <= height_mm + margin_mm_)) {
    return std::nullopt;
  }
  const double column_squares = column_mm / board_.square_mm;
  const double row_squares = row_mm / board_.square_mm;
  const int column = static_cast<int>(std::floor(column_squares));
  const int row = static_cast<int>(std::floor(row_squares));
  if (column < 0 || row < 0 || column >= board_.squares_x || row >= board_.squares_y) return 1.0;
  if (!SquareExists(board_, column, row)) return std::nullopt;
  if (SquareIsBlack(board_, column, row)) return 0.0;
  if (marker_bits_.empty()) return 1.0;

  const auto& bits = marker_bits_[static_cast<size_t>(row) * board_.squares_x + column];
  const double marker_squares = board_.marker_mm / board_.square_mm;
  const double inset = 0.5 * (1.0 - marker_squares);
  const double cell_x = (column_squares - column - inset) / marker_squares * marker_cells_;
  const double cell_y = (row_squares - row - inset) / marker_squares * marker_cells_;
  if (!(cell_x >= 0 && cell_y >= 0 && cell_x < marker_cells_ && cell_y < marker_cells_)) return 1.0;
  return bits[static_cast<size_t>(cell_y) * marker_cells_ + static_cast<size_t>(cell_x)] ? 1.0
                                                                                         : 0.0;
}

}  // namespace glint
