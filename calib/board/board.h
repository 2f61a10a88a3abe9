// Calibration boards as plain values: what is printed where, in millimetres.
//
// Board frame = sample frame up to `board_centre_in_sample_mm`: x right, y up, z toward the viewer.
// Squares are numbered column i from the left, row j from the top; square (0, 0) at the top left.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

namespace glint {

enum class BoardKind { kCheckerboard, kCharuco };

// A rectangle of squares left empty, in which the sample lies: the board is then a frame.
struct BoardWindow {
  int first_column = 0, first_row = 0;
  int columns = 0, rows = 0;
};

struct Board {
  BoardKind kind = BoardKind::kCharuco;
  int squares_x = 0, squares_y = 0;  // squares, not inner corners
  double square_mm = 0;
  double marker_mm = 0;                      // ChArUco only
  std::string dictionary = "DICT_5X5_1000";  // ChArUco only: OpenCV's name of the ArUco dictionary
  // ChArUco only: the layout of OpenCV < 4.6 (setLegacyPattern of OpenCV >= 4.7), where boards with
  // an even number of rows have a marker, not a black square, at the top left. Odd rows: no
  // difference.
  bool legacy_layout = false;
  std::optional<BoardWindow> window;
  Eigen::Vector2d board_centre_in_sample_mm{0, 0};
};

// An inner corner of the squares. Ids are row-major over (squares_x − 1) × (squares_y − 1), top
// left first; corners that touch the window do not exist, and the others keep their ids.
struct BoardCorner {
  int id = 0;
  Eigen::Vector2d position_in_sample_mm;
};

// A marker: its id in the dictionary and its four corners, clockwise from its own top left.
struct BoardMarker {
  int id = 0;
  Eigen::Vector2d corners_in_sample_mm[4];
};

// Returns what is wrong with the description ("" when nothing): field, found, mend.
std::string CheckBoard(const Board& board);

// Whether square (column, row) is printed: on the board and outside the window.
bool SquareExists(const Board& board, int column, int row);
// Square (0, 0) is black, and neighbours alternate (OpenCV >= 4.7; see legacy_layout). White
// squares of a ChArUco board hold the markers, numbered row by row from the top left; those that
// fall into the window keep their numbers, so that a frame is a full board with its middle cut out.
bool SquareIsBlack(const Board& board, int column, int row);
// The point `column` squares from the board's left edge and `row` squares below its top edge.
Eigen::Vector2d GridPointInSample(const Board& board, double column, double row);

std::vector<BoardCorner> BoardCorners(const Board& board);
std::vector<BoardMarker> BoardMarkers(const Board& board);  // empty for a checkerboard

// Reflectance factor in [0, 1] of the printed sheet at a point of the sample plane: ink 0, paper 1
// (paper also outside of the squares; nullopt outside the sheet, `margin_mm` around the squares,
// and in the window).
class BoardPainter {
 public:
  BoardPainter(const Board& board, double margin_mm);
  std::optional<double> ReflectanceAt(double x_mm, double y_mm) const;

 private:
  Board board_;
  double margin_mm_;
  std::vector<std::vector<unsigned char>> marker_bits_;  // per square; empty: no marker
  int marker_cells_ = 0;                                 // cells a side, border included
};

}  // namespace glint
