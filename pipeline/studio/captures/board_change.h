// A capture's board becomes another.
#pragma once

#include <array>
#include <filesystem>
#include <optional>

#include "pipeline/studio/captures/boards.h"

namespace glint {

struct BoardChange {
  KeptBoard board;
  std::optional<std::array<double, 2>> size_mm;  // of the sample; none: as it is
};

// The capture's board.json becomes the board's, and capture.toml names it. What was there is kept
// beside it as board-1.json …, a sheet (board.pdf, board.svg) under the same name. A Studio that is
// killed meanwhile leaves the capture with the one board or the other. Throws HttpError or
// UserError, and the capture then keeps its board: a window smaller than the sample, a capture.toml
// that only a person can change.
void ChangeBoard(const std::filesystem::path& capture, const BoardChange& change);

}  // namespace glint
