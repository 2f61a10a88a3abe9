// The board of synthetic captures, and of `glint demo`.
#pragma once

#include "base/board/board.h"

namespace glint {

inline constexpr double kUsualSample_mm = 100;  // side of the square sample

// A ChArUco frame on A4 across: 18 × 14 squares with a window of 8 × 8 in the middle, scaled so
// that a sample of `sample_mm` leaves 2 % of the window's side free all round.
Board FrameBoard(double sample_mm);

}  // namespace glint
