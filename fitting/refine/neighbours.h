// The texels beside a texel of a map.
#pragma once

#include <cstddef>

namespace glint {

// visit(neighbour) with the up to four texels above, left, right and below, in this order.
template <class Visit>
void ForEachNeighbour(size_t texel, int width, int height, const Visit& visit) {
  const size_t across = static_cast<size_t>(width);
  const size_t row = texel / across, column = texel % across;
  if (row > 0) visit(texel - across);
  if (column > 0) visit(texel - 1);
  if (column + 1 < across) visit(texel + 1);
  if (row + 1 < static_cast<size_t>(height)) visit(texel + across);
}

}  // namespace glint
