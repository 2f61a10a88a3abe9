// Slopes of one height field near those that texels were found with, each by itself.
//
// Slopes of a surface have no curl. What texels were found with has: of their errors, and of facets
// smaller than a texel (flakes, grains), whose normals are no height field's. Both have as much
// power without curl as with it, so that the second tells the first: where slopes have the power D
// without curl, C with it, and ε of that is error, the relief's most probable slopes are 1 − εC/D
// of what was found (Wiener 1949). Powers are means over rings of frequency; the share ε follows
// from the variance of the facets' slopes, which the caller knows. Slopes continue beyond the
// sample's border as if a mirror stood there (Frankot and Chellappa, "A method for enforcing
// integrability in shape from shading algorithms", PAMI 1988, with free borders).
//
// A large sample is done by tiles of kMostTileSide that overlap by half or more and are blended, so
// that rows depend on those of their tiles alone, however the sample is cut.
#pragma once

#include <array>
#include <span>
#include <vector>

namespace glint {

inline constexpr int kMostTileSide = 512;
// Of a tile's coefficients along its longer side, in one ring: its innermost has 85.
inline constexpr int kRingWidth = 10;

// Where tiles lie along an axis of `length` texels.
class TiledAxis {
 public:
  explicit TiledAxis(int length);
  int count() const { return static_cast<int>(first_.size()); }
  int first(int tile) const { return first_[static_cast<size_t>(tile)]; }
  int side() const { return side_; }  // even, and a product of 2, 3 and 5
  // The tile's share in the texel; of all tiles together 1.
  double Share(int tile, int texel) const;

 private:
  double Weight(int tile, int texel) const;
  int side_;
  std::vector<int> first_;
};

// Rows [first, last) of a sample.
struct RowSpan {
  int first = 0, last = 0;
  int size() const { return last - first; }
};
// Whether relief can be told from errors: not on fewer texels than a ring is wide.
bool SampleHasRelief(int width, int height);
// Rows whose slopes those of the asked ones depend on.
RowSpan RowsOfRelief(int height, RowSpan asked);

// `slopes`: n_x/n_z and n_y/n_z, W values a row, of the rows RowsOfRelief(height, asked) of a
// sample of `height` rows, the first at the top (+y). Returns those of the rows asked for: the same
// for any number of threads, and whatever rows are asked for at once. `facet_variance`: of either
// slope of the facets.
std::array<std::vector<float>, 2> SlopesOfRelief(std::array<std::span<const float>, 2> slopes,
                                                 int width, int height, double facet_variance,
                                                 RowSpan asked, int threads);

}  // namespace glint
