// Work cut into numbered pieces that any number of threads take in turn.
#pragma once

#include <functional>

namespace glint {

// Calls work(piece, worker) for every piece in [0, pieces), worker in [0, threads). Which worker
// gets a piece varies; results must depend on the piece alone. The first exception is rethrown when
// all threads have stopped.
void ForEachPiece(int pieces, int threads, const std::function<void(int piece, int worker)>& work);

}  // namespace glint
