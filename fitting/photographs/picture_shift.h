// A picture of the sample moved by a fraction of a texel: registration errors, made and undone.
#pragma once

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

// A plane looked up between its texels (Catmull-Rom, edges repeated), and its derivatives.
struct LookedUp {
  double value, by_column, by_row;
};
LookedUp LookUp(const float* plane, int width, int height, double column, double row);

// Share of the variance of white noise that looking up there leaves, mean over the picture: 1 at
// whole texels, .41 in the middle between four.
double NoiseLeft(const CornerShifts& shifts);

// `rgb_planar` looked up where the shifts say; not below 0.
void ShiftPicture(const CornerShifts& shifts, int width, int height,
                  std::vector<float>* rgb_planar);
// A mask likewise: 0 where any of the texels that the lookup weighs most (its 2×2) is below ½ or
// outside.
void ShiftMask(const CornerShifts& shifts, int width, int height, std::vector<float>* mask);

}  // namespace glint
