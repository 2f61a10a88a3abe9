#include "base/board/marker_ink.h"

namespace glint {

double PaperAt(const MarkerCells& marker, double x, double y) {
  if (!(x >= 0 && y >= 0 && x < marker.cells && y < marker.cells)) return 1.0;
  const size_t cell = static_cast<size_t>(y) * marker.cells + static_cast<size_t>(x);
  return marker.paper[cell] != 0 ? 1.0 : 0.0;
}

InkShape ShapeOfMarker(const std::string& dictionary, const BoardMarker& marker) {
  const MarkerCells cells = CellsOfMarker(dictionary, marker.id);
  const auto& c = marker.corners_in_sample_mm;
  const auto at = [&](int column, int row) -> Eigen::Vector2d {
    const double u = static_cast<double>(column) / cells.cells;
    const double v = static_cast<double>(row) / cells.cells;
    const Eigen::Vector2d top = c[0] + u * (c[1] - c[0]), bottom = c[3] + u * (c[2] - c[3]);
    return top + v * (bottom - top);
  };
  InkShape black;
  for (int row = 0; row < cells.cells; ++row) {
    for (int column = 0; column < cells.cells;) {
      int end = column;
      while (end < cells.cells && !cells.paper[static_cast<size_t>(row) * cells.cells + end]) ++end;
      if (end > column) {
        black.push_back({at(column, row + 1), at(end, row + 1), at(end, row), at(column, row)});
      }
      column = end + 1;
    }
  }
  return black;
}

}  // namespace glint
