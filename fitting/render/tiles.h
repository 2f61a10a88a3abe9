// Work cut into tiles that do not depend on the number of threads, so that results do not either.
#pragma once

#include <functional>

namespace glint {

// Runs task(tile) once for every tile in [0, tiles), in any order, from any thread.
using TileRunner = std::function<void(int tiles, const std::function<void(int tile)>& task)>;

// Calls task(0) … task(tiles − 1), from up to `threads` threads (≤ 0: one per core). The first
// exception thrown by a task is thrown again here once all threads have ended.
void RunTiles(int tiles, int threads, const std::function<void(int tile)>& task);

}  // namespace glint
