#include "calib/registration/window_textures.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "base/model/registration.h"

namespace glint {
std::vector<cv::Rect> WindowsOf(const DetailPictures& pictures, const cv::Size& size, int width,
                                int step) {
  std::vector<cv::Rect> windows;
  const int rim = pictures.surrounded()
                      ? static_cast<int>(
                            std::lround(constants::kTextureRim * std::max(size.width, size.height)))
                      : 0;
  for (int y = rim; y + width + rim <= size.height; y += step) {
    for (int x = rim; x + width + rim <= size.width; x += step) {
      windows.emplace_back(x, y, width, width);
    }
  }
  return windows;
}

Eigen::MatrixXd WindowTextures::Covariance() const {
  const Eigen::MatrixXf products = values * weight.asDiagonal() * values.transpose();
  return products.cast<double>();
}

WindowTextures TexturesOf(const DetailPictures& pictures, const SamplePlaces& places,
                          const cv::Size& size, const cv::Rect& window) {
  cv::Mat taper;
  cv::createHanningWindow(taper, window.size(), CV_32F);
  WindowTextures textures;
  textures.weight = Eigen::Map<const Eigen::RowVectorXf>(taper.ptr<float>(), window.area());
  textures.weight /= textures.weight.sum();
  textures.values.resize(pictures.views(), window.area());
  for (int view = 0; view < pictures.views(); ++view) {
    const cv::Mat texture = pictures.LookUp(view, places, size, window);
    const Eigen::Map<const Eigen::RowVectorXf> values(texture.ptr<float>(), window.area());
    textures.values.row(view) = values.array() - values.dot(textures.weight);
  }
  return textures;
}

}  // namespace glint
