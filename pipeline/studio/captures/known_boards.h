// Boards that Studio knows without a file.
#pragma once

#include <vector>

#include "pipeline/studio/captures/boards.h"

namespace glint {

// None whose description is among `others`.
std::vector<KeptBoard> KnownBoards(const std::vector<KeptBoard>& others);

}  // namespace glint
