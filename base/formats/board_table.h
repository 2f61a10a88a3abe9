// [board] of capture.toml, which describes the board or names its board.json.
#pragma once

#include <toml++/toml.h>
#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "base/board/board.h"

namespace glint {

struct BoardTable {
  Board board;                      // its centre is not known here
  std::string file;                 // relative to the capture's folder; empty: the table describes
  std::vector<std::string> photos;  // of the board alone, relative to the folder
};

// The keys by which the table describes a board.
inline constexpr std::array kBoardDescriptionKeys = {"kind",          "squares",   "inner_corners",
                                                     "square_mm",     "marker_mm", "dictionary",
                                                     "legacy_layout", "window"};

// none: there is no such table. `file` is the capture.toml. Throws UserError naming file, field,
// what was found and the remedy; the board passes CheckBoard. Included by .cc files only.
std::optional<BoardTable> ReadBoardTable(const std::filesystem::path& folder,
                                         const std::filesystem::path& file,
                                         const toml::table& document);

// The board that a capture.toml describes, wherever the file lies. Throws UserError also where it
// describes none, or names a board.json.
Board ReadDescribedBoard(const std::filesystem::path& file);

}  // namespace glint
