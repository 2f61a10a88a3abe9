#include "base/board/board.h"

#include <fmt/format.h>

#include <algorithm>

#include "base/board/dictionary.h"
#include "base/board/marker_frame.h"
#include "base/board/wrong_field.h"

namespace glint {
namespace {

constexpr int kMaxSquares = 200;  // a side; keeps memory bounded whatever a description says

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
  if (board.kind == BoardKind::kCheckerboard) {
    return WrongField("window", found + " with kind \"checkerboard\"",
                      "use kind = \"charuco\": only markers tell where on a frame a corner lies");
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

std::string CheckBoard(const Board& board) {
  if (!board.board_centre_in_sample_mm.allFinite()) {
    return WrongField("centre_mm", "a value that is not finite", "give two numbers in millimetres");
  }
  if (board.kind == BoardKind::kMarkers) return CheckMarkerFrame(board);
  const bool charuco = board.kind == BoardKind::kCharuco;
  const int least = charuco ? 2 : 3;
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
  if (charuco) {
    const std::string wrong = CheckMarkers(board);
    if (!wrong.empty()) return wrong;
  }
  return board.window ? CheckWindow(board) : "";
}

std::vector<BoardCorner> BoardCorners(const Board& board) {
  std::vector<BoardCorner> corners;
  if (board.kind == BoardKind::kMarkers) {
    for (const BoardMarker& marker : BoardMarkers(board)) {
      for (int k = 0; k < 4; ++k) {
        corners.push_back({4 * marker.id + k, marker.corners_in_sample_mm[k]});
      }
    }
    return corners;
  }
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

std::vector<BoardMarker> BoardMarkers(const Board& board) {
  std::vector<BoardMarker> markers;
  if (board.kind == BoardKind::kCheckerboard) return markers;
  if (board.kind == BoardKind::kMarkers) {
    for (const ListedMarker& listed : board.markers) {
      BoardMarker marker;
      marker.id = listed.id;
      for (int k = 0; k < 4; ++k) {
        marker.corners_in_sample_mm[k] =
            listed.corners_in_board_mm[k] + board.board_centre_in_sample_mm;
      }
      markers.push_back(marker);
    }
    return markers;
  }
  const double inset = 0.5 * (1.0 - board.marker_mm / board.square_mm);
  int id = 0;
  for (int row = 0; row < board.squares_y; ++row) {
    for (int column = 0; column < board.squares_x; ++column) {
      if (SquareIsBlack(board, column, row)) continue;
      const int marker_id = id++;  // the window takes no numbers away: a frame is a full board, cut
      if (!SquareExists(board, column, row)) continue;
      BoardMarker marker;
      marker.id = marker_id;
      const double left = column + inset, right = column + 1 - inset;
      const double top = row + inset, bottom = row + 1 - inset;
      marker.corners_in_sample_mm[0] = GridPointInSample(board, left, top);
      marker.corners_in_sample_mm[1] = GridPointInSample(board, right, top);
      marker.corners_in_sample_mm[2] = GridPointInSample(board, right, bottom);
      marker.corners_in_sample_mm[3] = GridPointInSample(board, left, bottom);
      markers.push_back(marker);
    }
  }
  return markers;
}

}  // namespace glint
