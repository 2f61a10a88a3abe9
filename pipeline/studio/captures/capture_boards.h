// Boards that captures use already, to be chosen for another one.
#pragma once

#include <vector>

#include "pipeline/studio/captures/boards.h"
#include "pipeline/studio/captures/library.h"

namespace glint {

// Named as their capture; each description once, and none that is among `kept`.
std::vector<KeptBoard> BoardsOfCaptures(const std::vector<LibraryEntry>& captures,
                                        const std::vector<KeptBoard>& kept);

}  // namespace glint
