// Sampled texels cut into blocks that are solved at once.
#pragma once

#include <algorithm>
#include <cstddef>

#include "base/parallel/parallel.h"
#include "fitting/texel/texel_batch.h"

namespace glint {

// visit(first, count, worker) for every block of [0, count); blocks do not depend on `threads`.
// Several batches, so that texels that are searched further fill batches of their own.
template <class Visit>
void ForEachSampleBlock(size_t count, int threads, const Visit& visit) {
  constexpr size_t kBlock = 4 * kBatch;
  ForEachPieceByWorker(static_cast<int>((count + kBlock - 1) / kBlock), threads,
                       [&](int piece, int worker) {
                         const size_t first = kBlock * static_cast<size_t>(piece);
                         visit(first, std::min(kBlock, count - first), worker);
                       });
}

}  // namespace glint
