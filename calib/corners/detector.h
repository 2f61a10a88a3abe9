// Finding a board's corners in a photograph.
//
// ChArUco: OpenCV's ArUco gives the markers' identities; homographies fitted to their neighbourhood
// predict each corner, and a fit of the corner's own picture (saddle.h) places it. OpenCV's
// interpolateCornersCharuco is not used: in 4.6 it is off by half a pixel (opencv_contrib#3024).
// Checkerboards: findChessboardCornersSB (then findChessboardCorners) finds a grid, which is grown
// over whatever part of the board can be seen; the same fit places its corners.
// Marker frames: ArUco's identities again, and a fit of each marker's whole outline
// (marker_outline.h), in linear light: a marker's corners are no saddles, and a tone curve would
// make each marker seem too small.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "base/board/board.h"
#include "calib/corners/gray_image.h"
#include "calib/corners/marker_outline.h"
#include "calib/corners/saddle.h"

namespace glint {

struct DetectorOptions {
  int longest_px =
      1600;  // boards are looked for in a copy reduced to this; corners are placed in full
  int min_corners = 6;  // fewer are no detection
  // Whether it is looked for what a description has wrong that does not explain the picture, which
  // takes several times as long as the detection.
  bool explain_mismatch = true;
  SaddleOptions saddle;
  OutlineOptions outline;
};

struct CornerObservation {
  int id = 0;                             // of BoardCorner
  Eigen::Vector2d position_in_sample_mm;  // on the board
  Eigen::Vector2d point_px;               // centre of the top-left pixel: (0.5, 0.5)
  double sigma_px = 0;                    // standard deviation by the fit's residuals
  double blur_px = 0;                     // σ of the edges' blur there
};

struct BoardDetection {
  std::vector<CornerObservation> corners;  // ascending id; empty: no detection, `problem` says why
  // False for a part of a checkerboard that could lie at several places of it: its corners hold for
  // the intrinsics, but tell nothing of where the sample is.
  bool position_known = true;
  std::string problem;
  bool mismatch = false;  // what is seen contradicts the description, which `problem` tells
  int markers = 0;        // markers of the board seen
};

// Never throws for a picture; `board` must pass CheckBoard.
BoardDetection DetectBoard(const GrayImage& image, const Board& board,
                           const DetectorOptions& options = {});

}  // namespace glint
