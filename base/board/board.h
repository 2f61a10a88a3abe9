// Calibration boards as plain values: what is printed where, in millimetres.
//
// Board frame: origin at the board's centre (of a marker frame: where its description has it), x
// right, y up, z toward the viewer. The sample frame is parallel to it, and the board's origin lies
// at `board_centre_in_sample_mm`.
// Squares are numbered column i from the left, row j from the top; square (0, 0) at the top left.
#pragma once

#include <Eigen/Core>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace glint {

// What a kind is: board_kind.h.
// kMarkers: single ArUco or AprilTag markers at listed places, as on a frame round the sample.
enum class BoardKind { kCheckerboard, kCharuco, kMarkers };

// A rectangle of squares left empty, in which the sample lies: the board is then a frame.
struct BoardWindow {
  int first_column = 0, first_row = 0;
  int columns = 0, rows = 0;
};

struct BoardRectangle {
  double left_mm = 0, bottom_mm = 0, right_mm = 0, top_mm = 0;
};

// A marker: its id in the dictionary and its four corners, clockwise from its own top left (that of
// the marker as OpenCV draws it).
struct ListedMarker {
  int id = 0;
  Eigen::Vector2d corners_in_board_mm[4];
};

// A printed patch of even grey beside the squares.
struct BoardPatch {
  BoardRectangle in_board;
  double reflectance = 0;  // linear, as recorded in the description; white paper below 1 too
};

// Two marks whose distance a person can measure.
struct BoardRuler {
  Eigen::Vector2d from_in_board_mm{0, 0}, to_in_board_mm{0, 0};
  double length_mm() const { return (to_in_board_mm - from_in_board_mm).norm(); }
};

struct Board {
  BoardKind kind = BoardKind::kCharuco;
  int squares_x = 0, squares_y = 0;  // squares, not inner corners; kMarkers: 0
  // kMarkers: the unit of board coordinates, the mean side of its markers (MakeMarkerBoard).
  double square_mm = 0;
  double marker_mm = 0;                      // ChArUco only
  std::string dictionary = "DICT_5X5_1000";  // OpenCV's name; no meaning for a checkerboard
  // ChArUco only: the layout of OpenCV < 4.6 (setLegacyPattern of OpenCV >= 4.7), where boards with
  // an even number of rows have a marker, not a black square, at the top left. Odd rows: no
  // difference.
  bool legacy_layout = false;
  std::optional<BoardWindow> window;
  std::vector<ListedMarker> markers;               // kMarkers only
  std::optional<BoardRectangle> opening_in_board;  // kMarkers only: where the sample lies
  std::vector<BoardPatch> patches;
  std::optional<BoardRuler> ruler;
  double print_scale = 1;  // printed over designed size; all lengths above are as printed
  Eigen::Vector2d board_centre_in_sample_mm{0, 0};
};

// A point that detectors find. Squares: an inner corner; ids are row-major over (squares_x − 1) ×
// (squares_y − 1), top left first; corners that touch the window do not exist, and the others keep
// their ids. Marker frames: an outer corner of a marker, 4 · marker id + 0 … 3.
struct BoardCorner {
  int id = 0;
  Eigen::Vector2d position_in_sample_mm;
};

struct BoardMarker {  // as ListedMarker, in the sample frame
  int id = 0;
  Eigen::Vector2d corners_in_sample_mm[4];
};

// A place of plain paper on the board.
struct PaperSpot {
  Eigen::Vector2d squares;    // board coordinates: column to the right, row down
  double radius_squares = 0;  // of plain paper
  int block = 0;              // of 3 × 3 squares, in which it lies; of a marker frame: its marker
};

// Returns what is wrong with the description ("" when nothing): field, found, remedy.
std::string CheckBoard(const Board& board);

// A marker frame of these markers. Not checked: CheckBoard does that.
Board MakeMarkerBoard(const std::string& dictionary, std::vector<ListedMarker> markers);

// Multiplies every length of the board, as a printer that scales does.
void ScaleBoard(double factor, Board* board);

// The rectangle round all squares or markers, without paper round them.
BoardRectangle OutlineInSample(const Board& board);

// Where the sample lies: the window, or a marker frame's opening.
std::optional<BoardRectangle> OpeningInSample(const Board& board);

// The centre is board.board_centre_in_sample_mm.
BoardRectangle InSample(const Board& board, const BoardRectangle& in_board);

// Whether square (column, row) is printed: on the board and outside the window.
bool SquareExists(const Board& board, int column, int row);
// Square (0, 0) is black, and neighbours alternate (OpenCV >= 4.7; see legacy_layout). White
// squares of a ChArUco board hold the markers, numbered row by row from the top left; those that
// fall into the window keep their numbers, so that a frame is a full board with its middle cut out.
bool SquareIsBlack(const Board& board, int column, int row);
// The point `column` squares from the board's left edge and `row` squares below its top edge.
Eigen::Vector2d GridPointInSample(const Board& board, double column, double row);

// Board coordinates in squares (column to the right, row down, from the top left corner); of a
// marker frame in mean sides of its markers, from the board's centre.
Eigen::Vector2d SquaresFromSample(const Board& board, const Eigen::Vector2d& position_in_sample_mm);

// Whether it looks the same from the other side of the table.
bool LooksTheSameUpsideDown(const Board& board);

std::vector<BoardCorner> BoardCorners(const Board& board);
std::vector<BoardMarker> BoardMarkers(const Board& board);  // empty for a checkerboard

// The places of the board that are farthest from ink, window and border, the largest first: discs
// of plain paper whose centres keep a radius from each other. The larger the disc, the less of the
// ink's blur and of JPEG's blocks reaches its middle. Discs of less than 0.45 of the largest radius
// are left out. Of a marker frame: the rims of its markers.
std::vector<PaperSpot> PaperSpots(const Board& board);

// "ChArUco frame, 13 x 17 squares of 15 mm, …": what the board is, in ASCII.
std::string BoardInWords(const Board& board);

class BoardInk;  // board_kind.h

// Reflectance factor in [0, 1] of the printed sheet at a point of the sample plane: ink 0, paper 1,
// patches their own (paper also outside of squares and markers; nullopt outside the sheet,
// `margin_mm` around squares or markers, and in the window).
class BoardPainter {
 public:
  BoardPainter(const Board& board, double margin_mm);
  std::optional<double> ReflectanceAt(double x_mm, double y_mm) const;

 private:
  Board board_;
  BoardRectangle sheet_;
  std::shared_ptr<const BoardInk> ink_;
};

}  // namespace glint
