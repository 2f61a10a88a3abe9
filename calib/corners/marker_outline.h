// The four corners of a marker, from a least-squares fit of the picture of its outline.
//
// A marker is a black square on white paper. Near its outline the picture, in linear light, is
//   I(x) = p(x) + (k − p(x)) · Π_i Φ(d_i(x) / σ),   p(x) = p0 + a·(x − c),
// with Φ the normal distribution, σ the blur, and d_i the distance to the i-th side, positive
// inside. A side is the straight line between its corners plus a bulge b_i·4t(1 − t), t ∈ [0, 1]
// along the side, for the lens' distortion: over a side of 100 pixels that is up to 0.3 px. The
// four corners, σ, p0, a, k and the b_i are fitted by Levenberg–Marquardt to the pixels of a band
// along the outline that no other ink reaches.
//
// An outline has no symmetry that forgives a tone curve: in a gamma-encoded picture a blurred edge
// lies up to 0.3 px toward the ink. So the picture is taken to be encoded by gamma 2.2, which
// phones and GrayFromPhoto come close to, and is decoded first.
#pragma once

#include <Eigen/Core>

#include "calib/corners/gray_image.h"

namespace glint {

struct OutlineOptions {
  double max_shift_cells = 0.8;     // a corner's way from the guess
  double min_cell_px = 2.0;         // markers with smaller cells are not fitted
  double max_band_px = 6;           // half the width of the band
  double max_residual = 0.15;       // RMS over contrast p0 − k
  double max_side_residual = 0.08;  // mean over any eighth of a side; what hides a part shows here
  double max_sigma_px = 0.5;
  double min_contrast = 0.02;  // p0 − k, of 1
};

struct OutlineFit {
  bool ok = false;
  Eigen::Vector2d corners_px[4];
  double sigma_px[4] = {0, 0, 0, 0};  // standard deviation per coordinate, by the residuals
  double blur_px = 0, contrast = 0, residual = 0;
};

// `guess_px`: the corners within `max_shift_cells`, in turn, clockwise in the picture. `cells`: a
// side in cells, the black border included.
OutlineFit FitOutline(const GrayImage& image, const Eigen::Vector2d guess_px[4], int cells,
                      const OutlineOptions& options);

}  // namespace glint
