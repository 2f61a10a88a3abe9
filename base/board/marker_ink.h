// What is black of a marker; not for other folders.
#pragma once

#include "base/board/board_kind.h"
#include "base/board/dictionary.h"

namespace glint {

// 0 or 1 at (x, y), in cells from the marker's top left corner; outside of it there is paper.
double PaperAt(const MarkerCells& marker, double x, double y);

// Runs of black cells along a row are one polygon.
InkShape ShapeOfMarker(const std::string& dictionary, const BoardMarker& marker);

}  // namespace glint
