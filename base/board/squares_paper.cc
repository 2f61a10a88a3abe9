// Plain paper of boards of squares.
#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "base/board/squares.h"

namespace glint {
namespace {

constexpr int kCells = 56;            // of a square's side, in the raster
constexpr int kBlock = 3;             // squares a side
constexpr double kLeastShare = 0.45;  // of the largest disc's radius
constexpr double kLargest = 0.3;      // squares: beyond, several discs tell more than one

// 255 where plain paper is, on a raster of the squares with one cell of ink around.
cv::Mat PaperRaster(const Board& board) {
  const BoardPainter painter(board, 0);
  cv::Mat raster(board.squares_y * kCells + 2, board.squares_x * kCells + 2, CV_8UC1,
                 cv::Scalar(0));
  for (int y = 0; y < board.squares_y * kCells; ++y) {
    for (int x = 0; x < board.squares_x * kCells; ++x) {
      const Eigen::Vector2d at = GridPointInSample(board, (x + 0.5) / kCells, (y + 0.5) / kCells);
      const auto reflectance = painter.ReflectanceAt(at.x(), at.y());
      if (reflectance && *reflectance > 0.5) raster.at<unsigned char>(y + 1, x + 1) = 255;
    }
  }
  return raster;
}

}  // namespace

std::vector<PaperSpot> PaperOfSquares(const Board& board) {
  cv::Mat distance;
  cv::distanceTransform(PaperRaster(board), distance, cv::DIST_L2, cv::DIST_MASK_PRECISE);
  distance = cv::min(distance, kLargest * kCells);
  double largest = 0;
  cv::minMaxLoc(distance, nullptr, &largest);
  struct Place {
    float radius;
    int x, y;
  };
  std::vector<Place> places;
  for (int y = 0; y < distance.rows; ++y) {
    for (int x = 0; x < distance.cols; ++x) {
      const float radius = distance.at<float>(y, x);
      if (radius >= kLeastShare * largest) places.push_back({radius, x, y});
    }
  }
  std::stable_sort(places.begin(), places.end(),
                   [](const Place& a, const Place& b) { return a.radius > b.radius; });
  cv::Mat taken(distance.size(), CV_8UC1, cv::Scalar(0));
  std::vector<PaperSpot> spots;
  for (const Place& place : places) {
    if (taken.at<unsigned char>(place.y, place.x)) continue;
    cv::circle(taken, {place.x, place.y}, static_cast<int>(std::ceil(1.5f * place.radius)),
               cv::Scalar(255), cv::FILLED);
    const Eigen::Vector2d squares((place.x - 0.5) / kCells, (place.y - 0.5) / kCells);
    const int across = (board.squares_x + kBlock - 1) / kBlock;
    const int block =
        static_cast<int>(squares.y()) / kBlock * across + static_cast<int>(squares.x()) / kBlock;
    spots.push_back({squares, place.radius / kCells, block});
  }
  std::stable_sort(spots.begin(), spots.end(),
                   [](const PaperSpot& a, const PaperSpot& b) { return a.block < b.block; });
  return spots;
}

}  // namespace glint
