// A piece of the sample that repeats without visible borders.
//
//   1. Slow changes over the sample (shading that fitting took for colour, a tilt) are taken out.
//   2. The piece whose ends fit together best is chosen, across and then down (period.h).
//   3. Where it meets its own repetition, two copies of the sample overlap; they are joined along
//      the path on which they agree best (seam.h), all maps along the same one. A second path, that
//      also avoids places where the texture itself changes, is taken where its seam shows less.
//   4. Differences that are left along the paths are spread over their surroundings: the maps whose
//      gradients are nearest to those of the copies (gradient-domain blending, Perez et al. 2003),
//      on a torus, so that the repetition is exact.
//   5. Every map gets the mean and the spread back that it has in the whole sample after step 1.
//
// All in the encoding of the learned space (encoding.h): albedos by their roots, normals as slopes.
// The same bits for any number of threads.
#pragma once

#include <array>
#include <string>

#include "base/reflectance/svbrdf_maps.h"
#include "fitting/tiling/period.h"

namespace glint {

struct TileOptions {
  double least_share = 0.4;    // sides of the piece, of the sample's
  double overlap = 0.125;      // of the sample's side
  double flatten = 1;          // share of slow changes that is taken out
  double flatten_scale = 0.5;  // what is slow: changes over this share of the sample's side
};

inline constexpr int kLeastTileTexels = 32;  // along each side of the sample

// Mean absolute difference between neighbouring texels of different copies, over that between all
// others, both added to one step of 8 bits, less than which nobody sees: 1 where a seam cannot be
// told from the texture.
struct SeamScore {
  double diffuse = 0, specular = 0, roughness = 0, normal = 0;
  double worst() const;
};

struct TileResult {
  SvbrdfMaps maps;        // repeat: the texel right of the last column is that of the first
  Interval across, down;  // of the sample's texels
  SeamScore seam;
};

// The whole sample after step 1.
SvbrdfMaps FlattenMaps(const SvbrdfMaps& maps, const TileOptions& options);

// Throws std::invalid_argument for maps of less than kLeastTileTexels along a side.
TileResult TileMaps(const SvbrdfMaps& maps, const TileOptions& options, int threads);

// 3 × 3 copies.
SvbrdfMaps Repeated(const SvbrdfMaps& tile, int across, int down);

}  // namespace glint
