// How much a tile differs from the sample that it was cut from: what `glint-eval tile` prints.
#pragma once

#include "base/reflectance/svbrdf_maps.h"
#include "fitting/tiling/tile_maps.h"

namespace glint {

// Relative differences of renderings of a tile from those of its sample, clipped to [0, 1]: of the
// mean over texels and of the standard deviation about it, of the worst channel. Seen and lit from
// the directions of NovelViews (map_error.h), from so far away that they are the same for all
// texels: tile and sample have different sizes.
struct TilingErrors {
  double mean = 0, spread = 0;                  // on average over views
  double largest_mean = 0, largest_spread = 0;  // of the worst view
};

TilingErrors CompareTile(const SvbrdfMaps& tile, const SvbrdfMaps& sample, int threads);

}  // namespace glint
