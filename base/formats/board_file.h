// board.json: a calibration board as it was printed. docs/boards.md and board.schema.json define
// the format.
#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <optional>

#include "base/board/board.h"
#include "base/files/json.h"

namespace glint {

inline constexpr int kBoardFormat = 1;

// The sheet of paper a board is designed for. Places on the sheet are millimetres from its bottom
// left corner.
struct BoardSheet {
  double width_mm = 0, height_mm = 0;
  Eigen::Vector2d board_centre_mm{0, 0};
};

struct BoardFile {
  Board board;                      // its centre is the sample frame's origin
  std::optional<BoardSheet> sheet;  // as designed, whatever the print scale
};

Json ToJson(const BoardFile& file);

// Throws UserError naming file, field, what was found and the remedy; the board passes CheckBoard.
BoardFile ReadBoardFile(const std::filesystem::path& file);

// The factor by which the board was printed too large (above 1) or too small, where its ruler
// measures `measured_mm`; the board is as the file has it. Throws UserError: no ruler, or a length
// that no printer makes of it.
double RulerFactor(const std::filesystem::path& file, const Board& board, double measured_mm);

// "97.4 % of its size: the ruler measures 146.1 mm and not 150 mm"
std::string PrintScaleInWords(const Board& board);

}  // namespace glint
