// The pyramid of a coarse-to-fine fit.
#pragma once

#include <utility>
#include <vector>

#include "base/reflectance/svbrdf_maps.h"
#include "fitting/encoding/encoding.h"

namespace glint {

// Sizes (width, height) from coarse to fine; each is half the next, rounded up, and the first has
// no side above `coarse_size` (if the full size allows). The last is the full size, or the first
// below it without a side above `finest_size`.
std::vector<std::pair<int, int>> LevelSizes(int width, int height, int coarse_size,
                                            int finest_size);

// Encoded maps at another size: bilinear where larger, tent-averaged where smaller (slopes
// average as they should; a normal's length plays no part).
EncodedMaps Resized(const EncodedMaps& maps, int width, int height);
// Rows first_row … first_row + rows − 1 of those.
EncodedMaps ResizedRows(const EncodedMaps& maps, int width, int height, int first_row, int rows);

}  // namespace glint
