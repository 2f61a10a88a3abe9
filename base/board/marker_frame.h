// Checks of marker frames; not for other folders.
#pragma once

#include <string>

#include "base/board/board.h"

namespace glint {

// As CheckBoard, for kind kMarkers.
std::string CheckMarkerFrame(const Board& board);

}  // namespace glint
