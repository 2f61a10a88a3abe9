#include "fitting/tiling/tile_maps.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <utility>
#include <vector>

#include "base/parallel/parallel.h"
#include "base/resampling/resampling.h"
#include "fitting/encoding/encoding.h"
#include "fitting/relief/torus_poisson.h"
#include "fitting/tiling/seam.h"

namespace glint {
namespace {

// Takes changes over less than 1/flatten_scale waves a side out of the maps; means stay.
EncodedMaps Flattened(const EncodedMaps& maps, const TileOptions& options) {
  const int cells = std::max(1, static_cast<int>(std::lround(1 / options.flatten_scale)));
  const int across = std::min(cells, maps.width), down = std::min(cells, maps.height);
  const std::vector<float> coarse =
      ResamplePlanes(maps.planes, maps.width, maps.height, TentTaps(maps.width, across),
                     TentTaps(maps.height, down));
  const std::vector<float> slow = ResamplePlanes(coarse, across, down, TentTaps(across, maps.width),
                                                 TentTaps(down, maps.height));
  EncodedMaps flat = maps;
  const size_t texels = static_cast<size_t>(maps.width) * maps.height;
  for (int p = 0; p < kEncodedChannels; ++p) {
    double mean = 0;
    for (size_t i = 0; i < texels; ++i) mean += slow[p * texels + i];
    mean /= static_cast<double>(texels);
    for (size_t i = 0; i < texels; ++i) {
      flat.planes[p * texels + i] -=
          static_cast<float>(options.flatten * (slow[p * texels + i] - mean));
    }
  }
  return flat;
}

// Which texel of the sample stands where in the tile.
struct Layout {
  int width = 0, height = 0;
  std::vector<int> rows, columns;  // height·width
  size_t At(int row, int column) const { return static_cast<size_t>(row) * width + column; }
};

class Sample {
 public:
  explicit Sample(const EncodedMaps& maps)
      : maps_(maps), texels_(static_cast<size_t>(maps.width) * maps.height) {}
  float Value(int plane, int row, int column) const {
    return maps_.planes[plane * texels_ + static_cast<size_t>(row) * maps_.width + column];
  }
  double SquaredDifference(int row_a, int column_a, int row_b, int column_b) const {
    double sum = 0;
    for (int p = 0; p < kEncodedChannels; ++p) {
      const double d = Value(p, row_a, column_a) - Value(p, row_b, column_b);
      sum += d * d;
    }
    return sum;
  }
  // From the texel above (dr = 1) or left (dc = 1); 0 at the border.
  double SquaredStep(int row, int column, int dr, int dc) const {
    if (row < dr || column < dc) return 0;
    return SquaredDifference(row, column, row - dr, column - dc);
  }
  int width() const { return maps_.width; }
  int height() const { return maps_.height; }

 private:
  const EncodedMaps& maps_;
  size_t texels_;
};

// A path between two copies costs their squared difference, and `smoothness` times the squared step
// that each of them takes across the path by itself.

// For every row of the sample, the columns of a strip that repeats across: left of the path the
// continuation of the piece's end, right of it the piece's beginning.
std::vector<int> JoinAcross(const Sample& sample, const Interval& across, int overlap,
                            double smoothness) {
  const auto cost = [&](int row, int x) {
    const int a = across.begin + x, b = a + across.length;
    const double steps = sample.SquaredStep(row, a, 0, 1) + sample.SquaredStep(row, b, 0, 1);
    return sample.SquaredDifference(row, a, row, b) + smoothness * steps / 2;
  };
  const std::vector<int> path = CheapestPath(sample.height(), overlap, false, cost);
  std::vector<int> columns(static_cast<size_t>(sample.height()) * across.length);
  for (int row = 0; row < sample.height(); ++row) {
    for (int x = 0; x < across.length; ++x) {
      const bool continued = x < path[static_cast<size_t>(row)];
      columns[static_cast<size_t>(row) * across.length + x] =
          across.begin + x + (continued ? across.length : 0);
    }
  }
  return columns;
}

Layout JoinDown(const Sample& sample, const std::vector<int>& strip, const Interval& across,
                const Interval& down, int overlap, double smoothness) {
  const auto column = [&](int row, int x) {
    return strip[static_cast<size_t>(row) * across.length + x];
  };
  const auto cost = [&](int x, int y) {
    const int a = down.begin + y, b = a + down.length;
    const double steps =
        sample.SquaredStep(a, column(a, x), 1, 0) + sample.SquaredStep(b, column(b, x), 1, 0);
    return sample.SquaredDifference(a, column(a, x), b, column(b, x)) + smoothness * steps / 2;
  };
  const std::vector<int> path = CheapestPath(across.length, overlap, true, cost);
  Layout layout{across.length, down.length, {}, {}};
  for (int y = 0; y < down.length; ++y) {
    for (int x = 0; x < across.length; ++x) {
      const bool continued = y < path[static_cast<size_t>(x)];
      const int row = down.begin + y + (continued ? down.length : 0);
      layout.rows.push_back(row);
      layout.columns.push_back(column(row, x));
    }
  }
  return layout;
}

// Two neighbours in the tile, the second one step (dr, dc) from the first.
struct Pair {
  int row_a, column_a, row_b, column_b, dr, dc;
  // Neighbours in the sample too.
  bool natural() const { return row_b == row_a + dr && column_b == column_a + dc; }
};

Pair PairAt(const Layout& layout, int row, int column, int dr, int dc) {
  const size_t a = layout.At(row, column);
  const size_t b = layout.At((row + dr) % layout.height, (column + dc) % layout.width);
  return {layout.rows[a], layout.columns[a], layout.rows[b], layout.columns[b], dr, dc};
}

// The difference that belongs between the two: the mean of what each one's own copy says.
double WantedDifference(const Sample& sample, int plane, const Pair& pair) {
  double sum = 0;
  int count = 0;
  const int row_after = pair.row_a + pair.dr, column_after = pair.column_a + pair.dc;
  if (row_after < sample.height() && column_after < sample.width()) {
    sum += sample.Value(plane, row_after, column_after) -
           sample.Value(plane, pair.row_a, pair.column_a);
    ++count;
  }
  const int row_before = pair.row_b - pair.dr, column_before = pair.column_b - pair.dc;
  if (row_before >= 0 && column_before >= 0) {
    sum += sample.Value(plane, pair.row_b, pair.column_b) -
           sample.Value(plane, row_before, column_before);
    ++count;
  }
  return count > 0 ? sum / count : 0;
}

std::vector<double> BlendPlane(const Sample& sample, const Layout& layout, int plane,
                               double screening) {
  const size_t texels = layout.rows.size();
  std::vector<double> across(texels), down(texels), data(texels);
  for (int row = 0; row < layout.height; ++row) {
    for (int column = 0; column < layout.width; ++column) {
      const size_t i = layout.At(row, column);
      data[i] = sample.Value(plane, layout.rows[i], layout.columns[i]);
      across[i] = WantedDifference(sample, plane, PairAt(layout, row, column, 0, 1));
      down[i] = WantedDifference(sample, plane, PairAt(layout, row, column, 1, 0));
    }
  }
  return SolveTorusPoisson(layout.width, layout.height, across, down, data, screening);
}

struct Moments {
  double mean = 0, spread = 0;
};

Moments MomentsOf(const float* values, size_t count) {
  Moments moments;
  for (size_t i = 0; i < count; ++i) moments.mean += values[i];
  moments.mean /= static_cast<double>(count);
  for (size_t i = 0; i < count; ++i) moments.spread += std::pow(values[i] - moments.mean, 2);
  moments.spread = std::sqrt(moments.spread / static_cast<double>(count));
  return moments;
}

// Writes `blended` with the moments of `wanted`, within the encoding's range.
void MatchMoments(const std::vector<double>& blended, const Moments& wanted, float* out) {
  const std::vector<float> values(blended.begin(), blended.end());
  const Moments found = MomentsOf(values.data(), values.size());
  const double scale = found.spread > 0 ? wanted.spread / found.spread : 1;
  for (size_t i = 0; i < values.size(); ++i) {
    const double value = wanted.mean + scale * (values[i] - found.mean);
    out[i] = static_cast<float>(std::clamp(value, -1.0, 1.0));
  }
}

// Over the planes [first, last): differences across seams over the others.
double ScoreOf(const EncodedMaps& tile, const Layout& layout, int first, int last) {
  const Sample texels(tile);
  double seam = 0, natural = 0;
  long seams = 0, naturals = 0;
  for (int row = 0; row < layout.height; ++row) {
    for (int column = 0; column < layout.width; ++column) {
      for (const auto& [dr, dc] : {std::pair{0, 1}, std::pair{1, 0}}) {
        double difference = 0;
        for (int p = first; p < last; ++p) {
          difference +=
              std::abs(texels.Value(p, (row + dr) % layout.height, (column + dc) % layout.width) -
                       texels.Value(p, row, column));
        }
        const bool is_natural = PairAt(layout, row, column, dr, dc).natural();
        (is_natural ? natural : seam) += difference;
        ++(is_natural ? naturals : seams);
      }
    }
  }
  if (seams == 0 || naturals == 0) return 1;
  constexpr double kStep = 2.0 / 255;  // of the encoding's range, [−1, 1]
  const double visible = kStep * (last - first);
  return (seam / static_cast<double>(seams) + visible) /
         (natural / static_cast<double>(naturals) + visible);
}

// The path on which copies agree best is not always the one that shows least: copies of a floor
// agree in its joints, whose texels differ more from their neighbours than others do. Where copies
// agree everywhere, the steps alone would decide, and do worse. So both are tried. .03, .1 and .3
// show the same on the floor (docs/experiments/tiling.md).
constexpr std::array kSmoothness = {0.0, 0.1};

struct Piece {
  Interval across, down;
  int overlap_x, overlap_y;
};

Piece BestPiece(const EncodedMaps& maps, const TileOptions& options) {
  const auto share = [](double of, int size) {
    return std::max(2, static_cast<int>(std::lround(of * size)));
  };
  const auto least = [&](int size, int overlap) {
    return std::min(share(options.least_share, size), size - overlap);
  };
  const int overlap_x = share(options.overlap, maps.width);
  const int overlap_y = share(options.overlap, maps.height);
  return {BestInterval(maps, true, least(maps.width, overlap_x), overlap_x),
          BestInterval(maps, false, least(maps.height, overlap_y), overlap_y), overlap_x,
          overlap_y};
}

TileResult Joined(const EncodedMaps& maps, const Piece& piece, double smoothness, int threads) {
  const Sample sample(maps);
  const std::vector<int> strip = JoinAcross(sample, piece.across, piece.overlap_x, smoothness);
  const Layout layout =
      JoinDown(sample, strip, piece.across, piece.down, piece.overlap_y, smoothness);
  // What is left of a jump fades over half the overlap.
  const double screening = std::pow(2.0 / std::min(piece.overlap_x, piece.overlap_y), 2);
  EncodedMaps tile(layout.width, layout.height);
  ForEachPiece(kEncodedChannels, threads, [&](int p) {
    const Moments wanted = MomentsOf(maps.planes.data() + p * maps.texels(), maps.texels());
    MatchMoments(BlendPlane(sample, layout, p, screening), wanted,
                 tile.planes.data() + p * tile.texels());
  });
  const SeamScore seam = {ScoreOf(tile, layout, kEncodedDiffuse, kEncodedSpecular),
                          ScoreOf(tile, layout, kEncodedSpecular, kEncodedRoughness),
                          ScoreOf(tile, layout, kEncodedRoughness, kEncodedNormal),
                          ScoreOf(tile, layout, kEncodedNormal, kEncodedChannels)};
  return {DecodeMaps(tile), piece.across, piece.down, seam};
}

}  // namespace

double SeamScore::worst() const { return std::max({diffuse, specular, roughness, normal}); }

SvbrdfMaps FlattenMaps(const SvbrdfMaps& maps, const TileOptions& options) {
  return DecodeMaps(Flattened(EncodeMaps(maps), options));
}

TileResult TileMaps(const SvbrdfMaps& maps, const TileOptions& options, int threads) {
  if (std::min(maps.width, maps.height) < kLeastTileTexels) {
    throw std::invalid_argument("tiling needs maps of at least " +
                                std::to_string(kLeastTileTexels) + " texels along each side");
  }
  const EncodedMaps flat = Flattened(EncodeMaps(maps), options);
  const Piece piece = BestPiece(flat, options);
  TileResult best;
  best.seam.diffuse = std::numeric_limits<double>::infinity();
  for (const double smoothness : kSmoothness) {
    TileResult result = Joined(flat, piece, smoothness, threads);
    if (result.seam.worst() < best.seam.worst()) best = std::move(result);
  }
  return best;
}

SvbrdfMaps Repeated(const SvbrdfMaps& tile, int across, int down) {
  SvbrdfMaps out(across * tile.width, down * tile.height);
  for (int p = 0; p < kSvbrdfPlanes; ++p) {
    for (int row = 0; row < out.height; ++row) {
      for (int column = 0; column < out.width; ++column) {
        out.plane(p)[static_cast<size_t>(row) * out.width + column] = tile.plane(
            p)[static_cast<size_t>(row % tile.height) * tile.width + column % tile.width];
      }
    }
  }
  return out;
}

}  // namespace glint
