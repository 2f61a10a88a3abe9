// The place of a checkerboard corner, from a least-squares fit of its picture.
//
// Near a corner c two straight edges cross, so a blurred corner is
//   I(x) = m + a·(x − c) + (k + b·(x − c)) · erf(n1·(x − c)/√2σ) · erf(n2·(x − c)/√2σ)
// with unit normals n1, n2 of the edges, blur σ, and linear terms a, b for uneven light. All eleven
// parameters are fitted by Levenberg–Marquardt. The picture of a corner is its own image under the
// point reflection at c, whatever the tone curve, which is why the fit is not biased; and a corner
// that something hides leaves residuals, which is why it can be told from a whole one.
#pragma once

#include <Eigen/Core>

#include "calib/corners/gray_image.h"

namespace glint {

// What is known beforehand, from the neighbourhood. Pixels; centre of the top-left one (0.5, 0.5).
struct SaddleGuess {
  Eigen::Vector2d centre_px;
  Eigen::Vector2d column_px;      // image step of one square to the right on the board
  Eigen::Vector2d row_px;         // image step of one square down on the board
  bool top_left_is_black = true;  // the square up and left of the corner
  double radius_squares = 0.4;    // the fit sees the ellipse of this radius round the corner
};

struct SaddleFit {
  bool ok = false;
  Eigen::Vector2d centre_px;
  double sigma_px = 0;      // standard deviation of the centre, from the residuals
  double blur_px = 0;       // σ
  double contrast = 0;      // |k|, 0 … 127
  double residual = 0;      // RMS residual / |k|
  double worst_sector = 0;  // largest |mean residual| of eight sectors / |k|
};

struct SaddleOptions {
  double max_shift_squares = 0.2;     // the centre's way from the guess
  double max_radius_px = 16;          // the fit's radius is cut to this
  double min_radius_px = 2.5;         // smaller corners are not fitted
  double min_contrast = 4;            // |k| in 8-bit levels
  double max_residual = 0.30;         // RMS / |k|; noise counts too
  double max_sector_residual = 0.15;  // what hides a part of the corner shows here
  double max_ramp = 0.9;              // |a| over the fit's radius / |k|
  double max_gain = 0.6;              // |b| over the fit's radius / |k|; near 1: half is hidden
  double max_sigma_px = 0.5;
  double max_turn_deg = 15;  // of each edge, from the guess
};

SaddleFit FitSaddle(const GrayImage& image, const SaddleGuess& guess, const SaddleOptions& options);

}  // namespace glint
