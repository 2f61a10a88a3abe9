#include "calib/corners/chessboard_grid.h"

#include <algorithm>
#include <opencv2/calib3d.hpp>

namespace glint::corners {
namespace {

// Points found in `part` of the reduced picture.
SeenGrid GridFrom(const std::vector<cv::Point2f>& points, int columns, int rows, cv::Rect part,
                  int factor) {
  SeenGrid grid{columns, rows, {}};
  // OpenCV's (0, 0) is the centre of the top-left pixel.
  for (const cv::Point2f& p : points) {
    grid.points_px.emplace_back((p.x + part.x + 0.5) * factor, (p.y + part.y + 0.5) * factor);
  }
  return grid;
}

// OpenCV asserts on some degenerate pictures; there is no board in those.
template <class Find>
bool Tried(Find find) {
  try {
    return find();
  } catch (const cv::Exception&) {
    return false;
  }
}

// Overlapping parts that share out the picture, coarse to fine.
std::vector<cv::Rect> Parts(cv::Size size) {
  std::vector<cv::Rect> parts = {{0, 0, size.width, size.height}};
  for (const auto& [count, share] : {std::pair{2, 0.6}, std::pair{3, 0.44}}) {
    const int width = static_cast<int>(size.width * share);
    const int height = static_cast<int>(size.height * share);
    for (int row = 0; row < count; ++row) {
      for (int column = 0; column < count; ++column) {
        parts.push_back({(size.width - width) * column / (count - 1),
                         (size.height - height) * row / (count - 1), width, height});
      }
    }
  }
  return parts;
}

// The picture as OpenCV's detectors get it.
struct ReducedPicture {
  int factor = 1;
  GrayImage gray;
  cv::Mat mat;  // of `gray`'s samples
  ReducedPicture(const GrayImage& image, int longest_px) {
    gray = Reduced(image, longest_px, &factor);
    mat = cv::Mat(gray.height, gray.width, CV_8U, gray.samples.data());
  }
};

}  // namespace

bool FindChessboardGrid(const GrayImage& image, int columns, int rows, int longest_px,
                        const AcceptGrid& accept) {
  const ReducedPicture picture(image, longest_px);
  const cv::Rect whole({0, 0}, picture.mat.size());
  std::vector<cv::Point2f> points;
  const auto exact = [&] {
    return cv::findChessboardCornersSB(picture.mat, {columns, rows}, points,
                                       cv::CALIB_CB_NORMALIZE_IMAGE);
  };
  if (Tried(exact) && accept(GridFrom(points, columns, rows, whole, picture.factor))) return true;
  for (const cv::Rect& part : Parts(picture.mat.size())) {
    cv::Mat meta;
    const auto larger = [&] {
      return cv::findChessboardCornersSB(
          picture.mat(part), {3, 3}, points,
          cv::CALIB_CB_NORMALIZE_IMAGE | cv::CALIB_CB_EXHAUSTIVE | cv::CALIB_CB_LARGER, meta);
    };
    if (!Tried(larger)) continue;
    if (static_cast<size_t>(meta.cols) * meta.rows != points.size()) continue;
    if (accept(GridFrom(points, meta.cols, meta.rows, part, picture.factor))) return true;
  }
  return false;
}

bool FindChessboardByQuads(const GrayImage& image, int columns, int rows, int longest_px,
                           const AcceptGrid& accept) {
  const ReducedPicture picture(image, longest_px);
  const cv::Rect whole({0, 0}, picture.mat.size());
  std::vector<cv::Point2f> points;
  const auto quads = [&] {
    return cv::findChessboardCorners(
        picture.mat, {columns, rows}, points,
        cv::CALIB_CB_ADAPTIVE_THRESH | cv::CALIB_CB_NORMALIZE_IMAGE | cv::CALIB_CB_FAST_CHECK);
  };
  return Tried(quads) && accept(GridFrom(points, columns, rows, whole, picture.factor));
}

}  // namespace glint::corners
