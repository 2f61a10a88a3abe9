// At which height the views' textures have most in common, window by window.
#pragma once

#include <vector>

#include "calib/registration/detail_pictures.h"

namespace glint {

struct WindowHeight {
  Eigen::Vector2d point_mm;  // the window's centre, in the sample's frame
  double height_mm = 0;      // beyond the places' plane
};

// Heights that factor analysis makes most likely (factor_analysis.h), near `places`'. What moves
// with the light is no displacement to it, and neither is it mistaken for one, as it is where
// textures are compared by pairs. Empty with too few views for it, or without texture. The same for
// any number of threads.
// Of windows that tell: a gain of constants::kTellingLogLikelihood over the heights about it is
// more than noise makes of itself. `near`: the places are right to a pixel, which takes half as
// long.
std::vector<WindowHeight> WindowHeights(const DetailPictures& pictures, const SamplePlaces& places,
                                        const cv::Size& size, bool near, int threads);

// How little likely what is seen in windows (columns) is at heights (rows) above the places' plane:
// −2 log likelihood of a texel, up to a constant, by factor analysis with as many factors as the
// views can tell, or one where all views are too few for any. 0 where too few show texture.
Eigen::MatrixXd HeightMisfits(const DetailPictures& pictures, const SamplePlaces& places,
                              const cv::Size& size, const std::vector<cv::Rect>& windows,
                              const std::vector<double>& heights, int threads);

// The largest displacement of two views against each other by a plane 1 mm higher, in millimetres.
double LargestParallax(const DetailPictures& pictures);

}  // namespace glint
