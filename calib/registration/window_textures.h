// The views' textures in one window of the sample, looked up at given places.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "calib/registration/detail_pictures.h"

namespace glint {

// Windows of `width` pixels every `step` of them, of pictures of `size`; away from the rim where
// views show what is beside the sample, which reaches a little into its high-passed detail.
std::vector<cv::Rect> WindowsOf(const DetailPictures& pictures, const cv::Size& size, int width,
                                int step);

struct WindowTextures {
  Eigen::MatrixXf values;     // a row a view: its pixels, less their weighted mean
  Eigen::RowVectorXf weight;  // of the pixels, a Hann window; their sum is 1

  Eigen::MatrixXd Covariance() const;  // of the views
};
WindowTextures TexturesOf(const DetailPictures& pictures, const SamplePlaces& places,
                          const cv::Size& size, const cv::Rect& window);

}  // namespace glint
