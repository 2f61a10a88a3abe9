#include "base/canvas/canvas.h"

#include <opencv2/core.hpp>

namespace glint {

Image ImageOf(const cv::Mat& canvas) {
  Image image(canvas.cols, canvas.rows, {"R", "G", "B"});
  for (int y = 0; y < canvas.rows; ++y) {
    for (int x = 0; x < canvas.cols; ++x) {
      const auto& pixel = canvas.at<cv::Vec3b>(y, x);
      for (int c = 0; c < 3; ++c) {
        image.channel(c)[static_cast<size_t>(y) * canvas.cols + x] = pixel[c] / 255.0f;
      }
    }
  }
  return image;
}

}  // namespace glint
