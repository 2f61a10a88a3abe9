#include "datasets/synth/frame_board.h"

namespace glint {

Board FrameBoard(double sample_mm) {
  Board board;
  board.kind = BoardKind::kCharuco;
  board.squares_x = 18;
  board.squares_y = 14;
  board.window = BoardWindow{5, 3, 8, 8};
  // 100 mm: squares of 13 mm, 234 × 182 mm, on A4 with 14 mm of margin above and below.
  board.square_mm = 1.04 * sample_mm / board.window->columns;
  board.marker_mm = board.square_mm * 0.75;
  board.dictionary = "DICT_5X5_1000";
  return board;
}

}  // namespace glint
