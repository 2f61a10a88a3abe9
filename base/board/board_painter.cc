#include <Eigen/Dense>
#include <cmath>

#include "base/board/board.h"
#include "base/board/dictionary.h"

namespace glint {
namespace {

// The homography that takes the marker's corners to those of the square (0, 0) … (cells, cells), y
// down: exact for squares, and for the slightly skewed ones of a measured board too.
Eigen::Matrix3d CellsFromSample(const BoardMarker& marker, int cells) {
  Eigen::Matrix<double, 8, 8> a;
  Eigen::Matrix<double, 8, 1> b;
  const double side = cells;
  const Eigen::Vector2d to[4] = {{0, 0}, {side, 0}, {side, side}, {0, side}};
  for (int k = 0; k < 4; ++k) {
    const Eigen::Vector2d& p = marker.corners_in_sample_mm[k];
    a.row(2 * k) << p.x(), p.y(), 1, 0, 0, 0, -p.x() * to[k].x(), -p.y() * to[k].x();
    a.row(2 * k + 1) << 0, 0, 0, p.x(), p.y(), 1, -p.x() * to[k].y(), -p.y() * to[k].y();
    b.segment<2>(2 * k) = to[k];
  }
  const Eigen::Matrix<double, 8, 1> h = a.fullPivLu().solve(b);
  Eigen::Matrix3d matrix;
  matrix << h[0], h[1], h[2], h[3], h[4], h[5], h[6], h[7], 1;
  return matrix;
}

bool Inside(const BoardRectangle& r, double x_mm, double y_mm) {
  return x_mm >= r.left_mm && x_mm <= r.right_mm && y_mm >= r.bottom_mm && y_mm <= r.top_mm;
}

bool IsPaper(const std::vector<unsigned char>& cells, int side, double x, double y) {
  return cells[static_cast<size_t>(y) * side + static_cast<size_t>(x)] != 0;
}

}  // namespace

BoardPainter::BoardPainter(const Board& board, double margin_mm)
    : board_(board),
      margin_mm_(margin_mm),
      outline_(OutlineInSample(board)),
      opening_(OpeningInSample(board)) {
  if (board.kind == BoardKind::kMarkers) {
    for (const BoardMarker& marker : BoardMarkers(board)) {
      MarkerCells cells = CellsOfMarker(board.dictionary, marker.id);
      marker_cells_ = cells.cells;
      painted_markers_.push_back({CellsFromSample(marker, cells.cells), std::move(cells.paper)});
    }
  }
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

double BoardPainter::MarkerFrameAt(const Eigen::Vector2d& in_sample_mm) const {
  for (const PaintedMarker& marker : painted_markers_) {
    const Eigen::Vector3d cell = marker.cells_from_sample * in_sample_mm.homogeneous();
    if (!(cell.z() > 0)) continue;
    const double x = cell.x() / cell.z(), y = cell.y() / cell.z();
    if (!(x >= 0 && y >= 0 && x < marker_cells_ && y < marker_cells_)) continue;
    return IsPaper(marker.paper, marker_cells_, x, y) ? 1.0 : 0.0;
  }
  return 1.0;
}

std::optional<double> BoardPainter::ReflectanceAt(double x_mm, double y_mm) const {
  for (const BoardPatch& patch : board_.patches) {
    if (Inside(InSample(board_, patch.in_board), x_mm, y_mm)) return patch.reflectance;
  }
  const BoardRectangle sheet{outline_.left_mm - margin_mm_, outline_.bottom_mm - margin_mm_,
                             outline_.right_mm + margin_mm_, outline_.top_mm + margin_mm_};
  if (!Inside(sheet, x_mm, y_mm)) return std::nullopt;
  if (board_.kind == BoardKind::kMarkers) {
    if (opening_ && Inside(*opening_, x_mm, y_mm)) return std::nullopt;
    return MarkerFrameAt({x_mm, y_mm});
  }
  // Squares from the board's top left corner; row grows downward.
  const double column_squares = (x_mm - outline_.left_mm) / board_.square_mm;
  const double row_squares = (outline_.top_mm - y_mm) / board_.square_mm;
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
  return IsPaper(bits, marker_cells_, cell_x, cell_y) ? 1.0 : 0.0;
}

}  // namespace glint
