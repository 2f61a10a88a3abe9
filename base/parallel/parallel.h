// Work cut into numbered pieces that any number of threads take in turn, in rising order. Pieces
// must not depend on the number of threads, and results on the piece alone: then results are the
// same for any number of threads.
//
// `threads` ≤ 0 means one per core. Where the system gives fewer threads than asked for, those that
// it gives do the work. After a piece has thrown no further one is begun; once all threads have
// ended, the exception of the lowest piece that threw is rethrown, whatever the order of events.
#pragma once

#include <functional>

namespace glint {

// Calls work(piece) once for every piece in [0, pieces).
void ForEachPiece(int pieces, int threads, const std::function<void(int piece)>& work);

// Also says which thread is at work, worker in [0, threads), for scratch memory of its own. Which
// worker gets a piece varies from run to run.
void ForEachPieceByWorker(int pieces, int threads,
                          const std::function<void(int piece, int worker)>& work);

// Calls work(begin, end) for [0, count) cut into blocks of `block`, the last one maybe shorter.
void ForEachBlock(int count, int block, int threads,
                  const std::function<void(int begin, int end)>& work);

}  // namespace glint
