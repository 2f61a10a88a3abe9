#include "pipeline/studio/photographs/thumbnail.h"

#include <algorithm>
#include <cmath>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <vector>

#include "calib/capture/reduced_photo.h"

namespace glint {
namespace {

constexpr int kThumbnailSide_px = 320;

}  // namespace

std::string SmallJpeg(const StoredImage& image) {
  cv::Mat picture(image.height, image.width, CV_8UC3);
  for (size_t i = 0; i < image.pixels(); ++i) {
    for (int c = 0; c < 3; ++c) {
      const float value = std::clamp(image.at(i, c), 0.0f, 1.0f);
      picture.data[3 * i + 2 - static_cast<size_t>(c)] =
          static_cast<unsigned char>(std::lround(255 * value));
    }
  }
  const double scale =
      std::min(1.0, kThumbnailSide_px / static_cast<double>(std::max(image.width, image.height)));
  cv::Mat small;
  cv::resize(picture, small, {}, scale, scale, cv::INTER_AREA);
  std::vector<unsigned char> bytes;
  cv::imencode(".jpg", small, bytes, {cv::IMWRITE_JPEG_QUALITY, 80});
  return {bytes.begin(), bytes.end()};
}

std::string SmallJpegOf(const std::filesystem::path& photo) {
  int reduction = 1;
  return SmallJpeg(ReadReducedPhoto(photo, 2 * kThumbnailSide_px, &reduction).image);
}

}  // namespace glint
