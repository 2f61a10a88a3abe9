#include "base/board/squares.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/board/wrong_field.h"

namespace glint {
namespace {

constexpr int kMaxSquares = 200;  // a side; keeps memory bounded whatever a description says

}  // namespace

bool SquareExists(const Board& board, int column, int row) {
  if (column < 0 || row < 0 || column >= board.squares_x || row >= board.squares_y) return false;
  if (!board.window) return true;
  const BoardWindow& w = *board.window;
  return column < w.first_column || column >= w.first_column + w.columns || row < w.first_row ||
         row >= w.first_row + w.rows;
}

bool SquareIsBlack(const Board& board, int column, int row) {
  const bool shifted =
      board.kind == BoardKind::kCharuco && board.legacy_layout && board.squares_y % 2 == 0;
  return ((column + row) % 2 == 0) != shifted;
}

Eigen::Vector2d GridPointInSample(const Board& board, double column, double row) {
  return board.board_centre_in_sample_mm +
         board.square_mm *
             Eigen::Vector2d(column - 0.5 * board.squares_x, 0.5 * board.squares_y - row);
}

Board ReadSquares(BoardKind kind, JsonObject* object) {
  Board board;
  board.kind = kind;
  const auto squares = object->Integers("squares", 2, "give [columns, rows] of squares");
  board.squares_x = squares[0];
  board.squares_y = squares[1];
  board.square_mm = object->Number("square_mm", 1e-3, 1e4, "give the side of a square");
  return board;
}

void WriteSquares(const Board& board, Json* json) {
  (*json)["squares"] = {board.squares_x, board.squares_y};
  (*json)["square_mm"] = board.square_mm;
}

std::string CheckSquares(const Board& board, int least) {
  if (board.squares_x < least || board.squares_y < least || board.squares_x > kMaxSquares ||
      board.squares_y > kMaxSquares) {
    return WrongField(
        "squares", fmt::format("[{}, {}]", board.squares_x, board.squares_y),
        fmt::format("give columns and rows of squares, {} to {} each", least, kMaxSquares));
  }
  if (!(board.square_mm > 0) || !(board.square_mm < 1e5)) {
    return WrongField("square_mm", fmt::format("{}", board.square_mm),
                      "give the side of a printed square in millimetres");
  }
  return "";
}

std::string SquaresInWords(const Board& board) {
  return fmt::format("{} x {} squares of {:.6g} mm", board.squares_x, board.squares_y,
                     board.square_mm);
}

BoardRectangle OutlineOfSquares(const Board& board) {
  const Eigen::Vector2d low = GridPointInSample(board, 0, board.squares_y);
  const Eigen::Vector2d high = GridPointInSample(board, board.squares_x, 0);
  return {low.x(), low.y(), high.x(), high.y()};
}

std::vector<BoardCorner> CornersOfSquares(const Board& board) {
  std::vector<BoardCorner> corners;
  for (int row = 1; row < board.squares_y; ++row) {
    for (int column = 1; column < board.squares_x; ++column) {
      // A corner is seen only where all four squares round it are printed.
      if (!SquareExists(board, column - 1, row - 1) || !SquareExists(board, column, row - 1) ||
          !SquareExists(board, column - 1, row) || !SquareExists(board, column, row)) {
        continue;
      }
      corners.push_back({(row - 1) * (board.squares_x - 1) + (column - 1),
                         GridPointInSample(board, column, row)});
    }
  }
  return corners;
}

std::vector<InkShape> ShapesOfSquares(const Board& board) {
  InkShape black;
  for (int row = 0; row < board.squares_y; ++row) {
    for (int column = 0; column < board.squares_x; ++column) {
      if (!SquareExists(board, column, row) || !SquareIsBlack(board, column, row)) continue;
      const Eigen::Vector2d low = GridPointInSample(board, column, row + 1);
      const Eigen::Vector2d high = GridPointInSample(board, column + 1, row);
      black.push_back({low, {high.x(), low.y()}, high, {low.x(), high.y()}});
    }
  }
  if (black.empty()) return {};
  return {black};
}

InkOfSquares::InkOfSquares(const Board& board) : board_(board), outline_(OutlineOfSquares(board)) {}

double InkOfSquares::OnWhite(int, int, double, double) const { return 1.0; }

std::optional<double> InkOfSquares::ReflectanceAt(const Eigen::Vector2d& in_sample_mm) const {
  // Squares from the board's top left corner; row grows downward.
  const double column_squares = (in_sample_mm.x() - outline_.left_mm) / board_.square_mm;
  const double row_squares = (outline_.top_mm - in_sample_mm.y()) / board_.square_mm;
  const int column = static_cast<int>(std::floor(column_squares));
  const int row = static_cast<int>(std::floor(row_squares));
  if (column < 0 || row < 0 || column >= board_.squares_x || row >= board_.squares_y) return 1.0;
  if (!SquareExists(board_, column, row)) return std::nullopt;
  if (SquareIsBlack(board_, column, row)) return 0.0;
  return OnWhite(column, row, column_squares - column, row_squares - row);
}

}  // namespace glint
