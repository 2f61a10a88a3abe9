// A board as a person describes it: a board.json, or a capture.toml whose table [board] says it.
#pragma once

#include <filesystem>
#include <string>

#include "base/formats/board_file.h"

namespace glint {

struct GivenBoard {
  std::string name;  // the file's, or one that tells the board
  std::string text;  // of its board.json
  BoardFile file;
};

// `file_name`: as the client names the file; empty where figures were typed. `scratch`: a folder
// in which a folder is made while the text is read. Throws UserError in terms of `file_name`.
GivenBoard ReadGivenBoard(const std::string& file_name, const std::string& text,
                          const std::filesystem::path& scratch);

}  // namespace glint
