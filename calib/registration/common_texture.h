// How much of a view's texture others explain, wherever the sample may have been moved to.
#pragma once

#include <Eigen/Core>
#include <opencv2/core.hpp>
#include <vector>

namespace glint {

// Of a picture against others, pixels: what lies at p in them lies at p + shift in it.
struct TextureShift {
  Eigen::Vector2d shift_px{0, 0};
  double explained = 0;  // share of the picture's variance, there
};

// Principal components of pictures of one size (CV_32F, each of norm 1), at most
// constants::kMostFactors: albedo and two slopes, in the pictures' own proportions. Compared by
// cross-correlation, by means of Fourier transforms.
class CommonTexture {
 public:
  // Shifts up to `reach_px` along each axis are tried.
  CommonTexture(const std::vector<cv::Mat>& pictures, int reach_px);

  // The nearest shift that explains more than those about it; or one further away that leaves less
  // than constants::kMoveExplains of what that one leaves: textures repeat themselves.
  TextureShift Compare(const cv::Mat& picture) const;
  double Explained(const cv::Mat& picture) const;  // as it lies

 private:
  cv::Mat Spectrum(const cv::Mat& picture) const;
  cv::Mat ExplainedByShift(const cv::Mat& picture) const;

  int reach_px_;
  cv::Size padded_;
  std::vector<cv::Mat> spectra_;
};

}  // namespace glint
