// What boards of squares have in common; not for other folders.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/board/board.h"
#include "base/board/board_kind.h"

namespace glint {

// The fields "squares" and "square_mm" of board.json.
Board ReadSquares(BoardKind kind, JsonObject* object);
void WriteSquares(const Board& board, Json* json);

// At least `least` squares a side.
std::string CheckSquares(const Board& board, int least);

std::string SquaresInWords(const Board& board);  // "13 x 17 squares of 15 mm"

BoardRectangle OutlineOfSquares(const Board& board);
std::vector<BoardCorner> CornersOfSquares(const Board& board);
std::vector<PaperSpot> PaperOfSquares(const Board& board);
// All black squares as one; none: no shape.
std::vector<InkShape> ShapesOfSquares(const Board& board);

// Squares alone, and what is printed on white ones.
class InkOfSquares : public BoardInk {
 public:
  explicit InkOfSquares(const Board& board);
  std::optional<double> ReflectanceAt(const Eigen::Vector2d& in_sample_mm) const override;

 protected:
  // Of white square (column, row) at (x, y), in squares from its top left corner.
  virtual double OnWhite(int column, int row, double x, double y) const;
  const Board& board() const { return board_; }

 private:
  Board board_;
  BoardRectangle outline_;
};

}  // namespace glint
