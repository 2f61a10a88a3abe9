// A picture of the sample moved by a fraction of a texel: registration errors, made and undone.
#pragma once

#include <cstddef>
#include <vector>

namespace glint {

// How far off, in texels, a picture's corners (top left, top right, bottom left, bottom right) are;
// between them the shift is bilinear.
struct CornerShifts {
  double column[4] = {0, 0, 0, 0}, row[4] = {0, 0, 0, 0};

  // At the centre of texel (column, row) of width × height.
  struct Shift {
    double column, row;
  };
  Shift At(int column, int row, int width, int height) const;
  bool any() const;
  double rms() const;  // of the four corners' lengths
};

// The weights of the four corners at (u, v) in [0, 1]² from the top left.
void CornerWeights(double u, double v, double weights[4]);

// Which rows of a picture of `of` rows are at hand: from `first` on.
struct PictureRows {
  int first = 0;
  int of = 0;  // 0: all are
};

// A plane looked up between its texels (Catmull-Rom, edges repeated), and its derivatives.
struct LookedUp {
  double value, by_column, by_row;
};
// One place in all planes of a picture. `row` counts from the picture's top; what is not at hand is
// as the nearest row that is.
class PictureLookUp {
 public:
  PictureLookUp(int width, int height, double column, double row, const PictureRows& rows = {});
  LookedUp In(const float* plane) const;

 private:
  std::ptrdiff_t first_of_row_[4];
  int columns_[4];
  double across_[4], down_[4], across_slopes_[4], down_slopes_[4];
};
LookedUp LookUp(const float* plane, int width, int height, double column, double row,
                const PictureRows& rows = {});

// Share of the variance of white noise that looking up there leaves, mean over the picture: 1 at
// whole texels, .41 in the middle between four.
double NoiseLeft(const CornerShifts& shifts);

// `rgb_planar` looked up where the shifts say; not below 0. Of rows of a picture, the outermost
// RowsReached() at a cut are wrong.
void ShiftPicture(const CornerShifts& shifts, int width, int height, std::vector<float>* rgb_planar,
                  const PictureRows& rows = {});
// A mask likewise: 0 where any of the texels that the lookup weighs most (its 2×2) is below ½ or
// outside.
void ShiftMask(const CornerShifts& shifts, int width, int height, std::vector<float>* mask,
               const PictureRows& rows = {});
// How many rows away a lookup may reach.
int RowsReached(const CornerShifts& shifts);

}  // namespace glint
