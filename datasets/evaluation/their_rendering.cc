#include "datasets/evaluation/their_rendering.h"

#include <opencv2/imgproc.hpp>

#include "base/linearize/linear_photo.h"

namespace glint {

std::vector<float> ReadTheirRendering(const std::filesystem::path& file, int width, int height) {
  Photo photo = ReadPhoto(file);
  const Encoding encoding = ResolveEncoding("gamma2.2", file, photo);
  const LinearPhoto linear(std::move(photo), encoding);
  cv::Mat picture(linear.height(), linear.width(), CV_32FC3);
  linear.Visit([&](const auto& reader) {
    for (size_t i = 0; i < picture.total(); ++i) {
      const auto pixel = reader.At(i);
      picture.ptr<cv::Vec3f>()[i] = {pixel.rgb[0], pixel.rgb[1], pixel.rgb[2]};
    }
  });
  if (picture.cols != width || picture.rows != height) {
    const bool smaller = width < picture.cols;
    cv::resize(picture, picture, {width, height}, 0, 0,
               smaller ? cv::INTER_AREA : cv::INTER_LINEAR);
  }
  std::vector<float> rgb(3 * picture.total());
  for (size_t i = 0; i < picture.total(); ++i) {
    for (size_t c = 0; c < 3; ++c) {
      rgb[c * picture.total() + i] = picture.ptr<cv::Vec3f>()[i][static_cast<int>(c)];
    }
  }
  return rgb;
}

}  // namespace glint
