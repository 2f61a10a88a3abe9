// Which of several boards a photograph shows.
#pragma once

#include <cstddef>
#include <filesystem>
#include <vector>

#include "base/board/board.h"

namespace glint {

// Their indices, the one of which most is found first. Boards that differ in their size alone look
// alike. Throws UserError where the file cannot be read.
std::vector<std::size_t> BoardsShown(const std::filesystem::path& photo,
                                     const std::vector<Board>& boards);

}  // namespace glint
