// Checks of marker frames; not for other folders.
#pragma once

#include <string>

#include "calib/board/board.h"

namespace glint {

// As CheckBoard, for kind kMarkers.
std::string CheckMarkerFrame(const Board& board);

}  // namespace glint
