#include <fmt/format.h>

#include "base/board/squares.h"
#include "base/board/wrong_field.h"

namespace glint {
namespace {

class Checkerboard : public KindOfBoard {
 public:
  const char* name() const override { return "checkerboard"; }
  const char* summary() const override { return "no window for the sample"; }
  bool fits_capture_toml() const override { return true; }

  Board Read(JsonObject* object) const override {
    return ReadSquares(BoardKind::kCheckerboard, object);
  }
  void Write(const Board& board, Json* json) const override { WriteSquares(board, json); }

  std::string Check(const Board& board) const override {
    if (const std::string wrong = CheckSquares(board, 3); !wrong.empty()) return wrong;
    if (!board.window) return "";
    const BoardWindow& w = *board.window;
    return WrongField("window",
                      fmt::format("[{}, {}, {}, {}] with kind \"checkerboard\"", w.first_column,
                                  w.first_row, w.columns, w.rows),
                      "use kind = \"charuco\": only markers tell where on a frame a corner lies");
  }

  std::string InWords(const Board& board) const override {
    return "checkerboard of " + SquaresInWords(board);
  }
  std::string InOneLine(const Board& board) const override {
    return fmt::format("{} {}x{} squares of {} mm", name(), board.squares_x, board.squares_y,
                       board.square_mm);
  }

  BoardRectangle Outline(const Board& board) const override { return OutlineOfSquares(board); }
  std::optional<BoardRectangle> Opening(const Board&) const override { return std::nullopt; }
  bool LooksTheSameUpsideDown(const Board& board) const override {
    return (board.squares_x + board.squares_y) % 2 == 0;
  }
  std::vector<BoardCorner> Corners(const Board& board) const override {
    return CornersOfSquares(board);
  }
  std::vector<BoardMarker> Markers(const Board&) const override { return {}; }
  std::vector<PaperSpot> Paper(const Board& board) const override { return PaperOfSquares(board); }
  std::unique_ptr<const BoardInk> Ink(const Board& board) const override {
    return std::make_unique<InkOfSquares>(board);
  }
  std::vector<InkShape> Shapes(const Board& board) const override { return ShapesOfSquares(board); }
};

}  // namespace

const KindOfBoard& CheckerboardKind() {
  static const Checkerboard kind;
  return kind;
}

}  // namespace glint
