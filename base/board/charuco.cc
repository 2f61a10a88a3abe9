// A checkerboard with an ArUco marker in each white square.
#include <fmt/format.h>

#include <utility>

#include "base/board/dictionary.h"
#include "base/board/marker_ink.h"
#include "base/board/squares.h"
#include "base/board/wrong_field.h"

namespace glint {
namespace {

std::string CheckWindow(const Board& board) {
  const BoardWindow& w = *board.window;
  const std::string found =
      fmt::format("[{}, {}, {}, {}]", w.first_column, w.first_row, w.columns, w.rows);
  if (w.columns < 1 || w.rows < 1 || w.first_column < 0 || w.first_row < 0 ||
      w.first_column > board.squares_x - w.columns || w.first_row > board.squares_y - w.rows) {
    return WrongField(
        "window", found,
        fmt::format("give [first column, first row, columns, rows] inside the {} x {} "
                    "squares of the board",
                    board.squares_x, board.squares_y));
  }
  if (BoardCorners(board).size() < 4) {
    return WrongField("window", found, "leave at least four inner corners round the window");
  }
  return "";
}

std::string CheckMarkers(const Board& board) {
  if (!(board.marker_mm > 0) || !(board.marker_mm < board.square_mm)) {
    return WrongField(
        "marker_mm", fmt::format("{}", board.marker_mm),
        fmt::format("give the side of the printed markers, above 0 and below square_mm "
                    "({})",
                    board.square_mm));
  }
  if (!DictionaryNumber(board.dictionary)) {
    return WrongField("dictionary", "\"" + board.dictionary + "\"",
                      fmt::format("use one of {}", fmt::join(DictionaryNames(), ", ")));
  }
  const int markers = board.squares_x * board.squares_y / 2;
  const int size = DictionarySize(board.dictionary);
  if (markers > size) {
    return WrongField(
        "dictionary", fmt::format("\"{}\" with {} markers", board.dictionary, size),
        fmt::format("{} x {} squares need {}: use a larger dictionary or fewer squares",
                    board.squares_x, board.squares_y, markers));
  }
  return "";
}

// visit(marker's number, column, row) of each white square that is printed.
template <class Visit>
void ForEachMarkedSquare(const Board& board, const Visit& visit) {
  int id = 0;
  for (int row = 0; row < board.squares_y; ++row) {
    for (int column = 0; column < board.squares_x; ++column) {
      if (SquareIsBlack(board, column, row)) continue;
      const int marker = id++;  // the window takes no numbers away: a frame is a full board, cut
      if (SquareExists(board, column, row)) visit(marker, column, row);
    }
  }
}

class InkOfCharuco : public InkOfSquares {
 public:
  explicit InkOfCharuco(const Board& board)
      : InkOfSquares(board), markers_(static_cast<size_t>(board.squares_x) * board.squares_y) {
    ForEachMarkedSquare(board, [&](int marker, int column, int row) {
      markers_[PlaceOf(column, row)] = CellsOfMarker(board.dictionary, marker);
    });
  }

 protected:
  double OnWhite(int column, int row, double x, double y) const override {
    const MarkerCells& marker = markers_[PlaceOf(column, row)];
    const double marker_squares = board().marker_mm / board().square_mm;
    const double inset = 0.5 * (1.0 - marker_squares);
    return PaperAt(marker, (x - inset) / marker_squares * marker.cells,
                   (y - inset) / marker_squares * marker.cells);
  }

 private:
  size_t PlaceOf(int column, int row) const {
    return static_cast<size_t>(row) * board().squares_x + column;
  }

  std::vector<MarkerCells> markers_;  // per square; no cells: no marker
};

class Charuco : public KindOfBoard {
 public:
  const char* name() const override { return "charuco"; }
  const char* summary() const override { return "a frame with a window for the sample"; }
  bool fits_capture_toml() const override { return true; }

  Board Read(JsonObject* object) const override {
    Board board = ReadSquares(BoardKind::kCharuco, object);
    board.marker_mm = object->Number("marker_mm", 1e-3, 1e4, "give the side of a marker");
    board.dictionary =
        DictionaryFromAnyName(object->Text("dictionary", "name it, for example \"DICT_5X5_1000\""));
    if (object->Has("legacy_layout")) board.legacy_layout = object->Flag("legacy_layout");
    if (object->Has("window")) {
      const auto w = object->Integers("window", 4, "give [first column, first row, columns, rows]");
      board.window = BoardWindow{w[0], w[1], w[2], w[3]};
    }
    return board;
  }

  void Write(const Board& board, Json* json) const override {
    WriteSquares(board, json);
    (*json)["marker_mm"] = board.marker_mm;
    (*json)["dictionary"] = board.dictionary;
    (*json)["legacy_layout"] = board.legacy_layout;
    if (board.window) {
      (*json)["window"] = {board.window->first_column, board.window->first_row,
                           board.window->columns, board.window->rows};
    }
  }

  std::string Check(const Board& board) const override {
    if (const std::string wrong = CheckSquares(board, 2); !wrong.empty()) return wrong;
    if (const std::string wrong = CheckMarkers(board); !wrong.empty()) return wrong;
    return board.window ? CheckWindow(board) : "";
  }

  std::string InWords(const Board& board) const override {
    std::string text =
        fmt::format("ChArUco {}, {}, markers of {:.6g} mm ({}{})", board.window ? "frame" : "board",
                    SquaresInWords(board), board.marker_mm, board.dictionary,
                    board.legacy_layout ? ", legacy layout" : "");
    if (board.window) {
      text += fmt::format(", window of {:.6g} x {:.6g} mm", board.window->columns * board.square_mm,
                          board.window->rows * board.square_mm);
    }
    return text;
  }

  std::string InOneLine(const Board& board) const override {
    std::string line =
        fmt::format("{} {}x{} squares of {} mm, {} of {} mm{}", name(), board.squares_x,
                    board.squares_y, board.square_mm, board.dictionary, board.marker_mm,
                    board.legacy_layout ? ", legacy layout" : "");
    if (board.window) {
      line += fmt::format(", window {} {} {} {}", board.window->first_column,
                          board.window->first_row, board.window->columns, board.window->rows);
    }
    return line;
  }

  BoardRectangle Outline(const Board& board) const override { return OutlineOfSquares(board); }

  std::optional<BoardRectangle> Opening(const Board& board) const override {
    if (!board.window) return std::nullopt;
    const BoardWindow& w = *board.window;
    const Eigen::Vector2d low = GridPointInSample(board, w.first_column, w.first_row + w.rows);
    const Eigen::Vector2d high = GridPointInSample(board, w.first_column + w.columns, w.first_row);
    return BoardRectangle{low.x(), low.y(), high.x(), high.y()};
  }

  bool LooksTheSameUpsideDown(const Board&) const override { return false; }
  std::vector<BoardCorner> Corners(const Board& board) const override {
    return CornersOfSquares(board);
  }

  std::vector<BoardMarker> Markers(const Board& board) const override {
    std::vector<BoardMarker> markers;
    const double inset = 0.5 * (1.0 - board.marker_mm / board.square_mm);
    ForEachMarkedSquare(board, [&](int id, int column, int row) {
      BoardMarker marker;
      marker.id = id;
      const double left = column + inset, right = column + 1 - inset;
      const double top = row + inset, bottom = row + 1 - inset;
      marker.corners_in_sample_mm[0] = GridPointInSample(board, left, top);
      marker.corners_in_sample_mm[1] = GridPointInSample(board, right, top);
      marker.corners_in_sample_mm[2] = GridPointInSample(board, right, bottom);
      marker.corners_in_sample_mm[3] = GridPointInSample(board, left, bottom);
      markers.push_back(marker);
    });
    return markers;
  }

  std::vector<PaperSpot> Paper(const Board& board) const override { return PaperOfSquares(board); }
  std::unique_ptr<const BoardInk> Ink(const Board& board) const override {
    return std::make_unique<InkOfCharuco>(board);
  }
  std::vector<InkShape> Shapes(const Board& board) const override {
    std::vector<InkShape> shapes = ShapesOfSquares(board);
    for (const BoardMarker& marker : Markers(board)) {
      shapes.push_back(ShapeOfMarker(board.dictionary, marker));
    }
    return shapes;
  }
};

}  // namespace

const KindOfBoard& CharucoKind() {
  static const Charuco kind;
  return kind;
}

}  // namespace glint
