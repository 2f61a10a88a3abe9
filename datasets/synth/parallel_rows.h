// Rows of an image shared out among threads. Which thread computes a row decides nothing, so the
// result does not depend on the number of threads.
#pragma once

#include <functional>

namespace glint {

// Calls body(row) once for every row in [0, rows), on `threads` threads (at least one). An
// exception of a row is rethrown here after all threads have ended.
void ParallelRows(int rows, int threads, const std::function<void(int)>& body);

}  // namespace glint
