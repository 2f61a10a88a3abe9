#include "calib/registration/detail_pictures.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <stdexcept>

#include "base/model/photographs.h"
#include "base/model/solver.h"

namespace glint {
namespace {

// As photographs are compared (base/reflectance/log_radiance.h).
constexpr auto kOffset = static_cast<float>(constants::kLogOffset);

cv::Mat DetailOf(const TopView& view, double coarse_px) {
  cv::Mat detail(view.height, view.width, CV_32F);
  const auto texels = static_cast<size_t>(view.width) * view.height;
  for (size_t i = 0; i < texels; ++i) {
    detail.ptr<float>()[i] = std::log(std::max(view.radiance[i], 0.0f) + kOffset);
  }
  cv::Mat coarse;
  cv::GaussianBlur(detail, coarse, {0, 0}, coarse_px);
  return detail - coarse;
}

// Itself, then each of half the size of the one before.
std::vector<cv::Mat> PyramidOf(const cv::Mat& detail) {
  std::vector<cv::Mat> levels = {detail};
  while (std::ssize(levels) < constants::kDetailLevels) {
    const cv::Mat& last = levels.back();
    cv::Mat half;
    cv::resize(last, half, {std::max(1, last.cols / 2), std::max(1, last.rows / 2)}, 0, 0,
               cv::INTER_AREA);
    levels.push_back(half);
  }
  return levels;
}

void Check(const RegistrationProblem& problem) {
  if (!(problem.sample_width_mm > 0 && problem.sample_height_mm > 0 && problem.margin >= 1)) {
    throw std::invalid_argument("registration: the sample has no size");
  }
  for (const TopView& view : problem.views) {
    const auto texels = static_cast<size_t>(view.width) * view.height;
    if (view.width != problem.views[0].width || view.height != problem.views[0].height ||
        view.radiance.size() != texels || texels == 0) {
      throw std::invalid_argument("registration: views of different sizes");
    }
    if (!(view.camera_mm.z() > 0)) {
      throw std::invalid_argument("registration: a camera below the sample");
    }
  }
}

}  // namespace

DetailPictures::DetailPictures(const RegistrationProblem& problem, double coarse)
    : problem_(problem) {
  Check(problem);
  for (const TopView& view : problem.views) {
    const double longest_px = std::max(view.width, view.height) / problem.margin;
    details_.push_back(PyramidOf(DetailOf(view, coarse * longest_px)));
  }
}

cv::Size DetailPictures::SizeOf(int longest) const {
  const double scale = longest / std::max(problem_.sample_width_mm, problem_.sample_height_mm);
  return {std::max(1, static_cast<int>(std::lround(problem_.sample_width_mm * scale))),
          std::max(1, static_cast<int>(std::lround(problem_.sample_height_mm * scale)))};
}

cv::Size DetailPictures::OwnSize() const {
  const cv::Mat& detail = details_[0][0];
  return SizeOf(
      static_cast<int>(std::lround(std::max(detail.cols, detail.rows) / problem_.margin)));
}

Eigen::Vector2d DetailPictures::SamplePoint(const cv::Size& size, double x_px, double y_px) const {
  return {(x_px / size.width - 0.5) * problem_.sample_width_mm,
          (0.5 - y_px / size.height) * problem_.sample_height_mm};
}

Eigen::Matrix3d DetailPictures::AssumedFromPlace(int view, const SamplePlaces& places) const {
  const auto k = static_cast<size_t>(view);
  return AssumedFromSample(places.plane, camera_mm(view)) *
         HomographyMatrix(places.homographies[k], places.unit_mm).inverse();
}

Eigen::Vector2d DetailPictures::AssumedPoint(int view, const SamplePlaces& places,
                                             const Eigen::Vector2d& point_mm) const {
  return (AssumedFromPlace(view, places) * point_mm.homogeneous()).hnormalized();
}

const cv::Mat& DetailPictures::LevelFor(int view, const cv::Size& size) const {
  const std::vector<cv::Mat>& levels = details_[static_cast<size_t>(view)];
  size_t level = 0;
  while (level + 1 < levels.size() &&
         levels[level + 1].cols >= 0.99 * problem_.margin * size.width) {
    ++level;
  }
  return levels[level];
}

cv::Mat DetailPictures::LookUp(int view, const SamplePlaces& places, const cv::Size& size,
                               const cv::Rect& part) const {
  const cv::Mat& detail = LevelFor(view, size);
  Eigen::Matrix3d picture_from_assumed, place_from_pixel;  // centres at whole numbers
  picture_from_assumed << detail.cols / (problem_.margin * problem_.sample_width_mm), 0,
      0.5 * detail.cols - 0.5, 0, -detail.rows / (problem_.margin * problem_.sample_height_mm),
      0.5 * detail.rows - 0.5, 0, 0, 1;
  const double across = problem_.sample_width_mm / size.width;
  const double down = problem_.sample_height_mm / size.height;
  place_from_pixel << across, 0, (part.x + 0.5 - 0.5 * size.width) * across, 0, -down,
      (0.5 * size.height - 0.5 - part.y) * down, 0, 0, 1;
  const Eigen::Matrix3d picture_from_pixel =
      picture_from_assumed * AssumedFromPlace(view, places) * place_from_pixel;
  cv::Matx33d map;
  for (int i = 0; i < 9; ++i) map.val[i] = picture_from_pixel(i / 3, i % 3);
  cv::Mat found;
  cv::warpPerspective(detail, found, map, part.size(), cv::INTER_CUBIC | cv::WARP_INVERSE_MAP,
                      cv::BORDER_CONSTANT, cv::Scalar(0));
  return found;
}

}  // namespace glint
