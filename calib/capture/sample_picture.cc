#include "calib/capture/sample_picture.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "calib/corners/local_homography.h"

namespace glint {
namespace {

constexpr double kMostPixels = 768 * 768;
constexpr double kFull = 65535;

// Of the sample and its margin, within the photograph.
cv::Rect PartOf(const Photo& photo, const std::vector<CornerObservation>& corners,
                const std::array<double, 2>& sample_size_mm,
                const std::vector<Eigen::Vector2d>& centres_mm) {
  const cv::Rect all(0, 0, photo.image.width, photo.image.height);
  std::vector<PlanePoint> points;
  points.reserve(corners.size());
  for (const CornerObservation& corner : corners) {
    points.push_back({corner.position_in_sample_mm, corner.point_px});
  }
  const auto h = FitHomography(points);
  if (!h) return all;
  double left = all.width, top = all.height, right = 0, bottom = 0;
  const Eigen::Array2d half_mm(0.5 * sample_size_mm[0], 0.5 * sample_size_mm[1]);
  for (const Eigen::Vector2d& centre : centres_mm) {
    for (const Eigen::Array2d& side : {Eigen::Array2d(-1, -1), {-1, 1}, {1, -1}, {1, 1}}) {
      const auto at = ApplyHomography(*h, centre + (kSampleMargin * side * half_mm).matrix());
      if (!at) return all;
      left = std::min(left, at->x());
      right = std::max(right, at->x());
      top = std::min(top, at->y());
      bottom = std::max(bottom, at->y());
    }
  }
  const cv::Point from(static_cast<int>(std::max(left, 0.0)), static_cast<int>(std::max(top, 0.0)));
  const cv::Point to(static_cast<int>(std::min<double>(right + 1, all.width)),
                     static_cast<int>(std::min<double>(bottom + 1, all.height)));
  if (to.x <= from.x || to.y <= from.y) return {};
  return {from, to};
}

// One channel's stored values there.
cv::Mat PlaneOf(const StoredImage& image, const cv::Rect& part, int channel) {
  cv::Mat plane(part.height, part.width, CV_32F);
  image.Visit([&](const auto& samples) {
    for (int y = 0; y < part.height; ++y) {
      const size_t first = static_cast<size_t>(part.y + y) * image.width + part.x;
      float* row = plane.ptr<float>(y);
      for (int x = 0; x < part.width; ++x) {
        row[x] = StoredImage::ValueOf(samples[3 * (first + x) + static_cast<size_t>(channel)]);
      }
    }
  });
  return plane;
}

}  // namespace

SamplePicture SamplePictureOf(const Photo& photo, const Encoding& encoding,
                              const std::vector<CornerObservation>& corners,
                              const std::array<double, 2>& sample_size_mm,
                              const std::vector<Eigen::Vector2d>& centres_mm) {
  const cv::Rect part = PartOf(photo, corners, sample_size_mm, centres_mm);
  if (part.empty()) return {};
  SamplePicture picture;
  picture.scale = std::min(1.0, std::sqrt(kMostPixels / part.area()));
  picture.width = std::max(1, static_cast<int>(std::lround(part.width * picture.scale)));
  picture.height = std::max(1, static_cast<int>(std::lround(part.height * picture.scale)));
  picture.scale = static_cast<double>(picture.width) / part.width;
  picture.left_px = part.x;
  picture.top_px = part.y;
  cv::Mat sum = cv::Mat::zeros(picture.height, picture.width, CV_32F);
  for (int c = 0; c < 3; ++c) {
    cv::Mat small;
    cv::resize(PlaneOf(photo.image, part, c), small, sum.size(), 0, 0, cv::INTER_AREA);
    sum += small / 3;
  }
  picture.values.resize(sum.total());
  for (size_t i = 0; i < picture.values.size(); ++i) {
    const float linear = LinearFromEncoded(encoding, sum.ptr<float>()[i]);
    const double root = std::sqrt(std::clamp(linear, 0.0f, 1.0f));
    picture.values[i] = static_cast<std::uint16_t>(std::lround(kFull * root));
  }
  return picture;
}

}  // namespace glint
