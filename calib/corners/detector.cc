#include "calib/corners/detector.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>

#include "calib/corners/detector_internal.h"

namespace glint {

namespace {

struct Detector {
  BoardKind kind;
  BoardDetection (*detect)(const GrayImage& image, const Board& board,
                           const DetectorOptions& options);
};

// One for each of BoardKinds().
constexpr Detector kDetectors[] = {
    {BoardKind::kCharuco, corners::DetectCharuco},
    {BoardKind::kCheckerboard, corners::DetectCheckerboard},
    {BoardKind::kMarkers, corners::DetectMarkerFrame},
};

}  // namespace

BoardDetection DetectBoard(const GrayImage& image, const Board& board,
                           const DetectorOptions& options) {
  BoardDetection detection;
  if (std::min(image.width, image.height) < 32) {
    detection.problem =
        fmt::format("the picture has only {} x {} pixels", image.width, image.height);
    return detection;
  }
  return std::find_if(std::begin(kDetectors), std::end(kDetectors),
                      [&](const Detector& detector) { return detector.kind == board.kind; })
      ->detect(image, board, options);
}

namespace corners {

std::optional<SaddleGuess> GuessCorner(const std::vector<PlanePoint>& points,
                                       const Eigen::Vector2d& at, bool top_left_is_black,
                                       double radius_squares) {
  const auto h = LocalHomography(points, at, kReachSquares);
  if (!h) return std::nullopt;
  const auto centre = ApplyHomography(*h, at);
  const auto left = ApplyHomography(*h, at - Eigen::Vector2d(0.5, 0));
  const auto right = ApplyHomography(*h, at + Eigen::Vector2d(0.5, 0));
  const auto up = ApplyHomography(*h, at - Eigen::Vector2d(0, 0.5));
  const auto down = ApplyHomography(*h, at + Eigen::Vector2d(0, 0.5));
  if (!centre || !left || !right || !up || !down) return std::nullopt;
  return SaddleGuess{*centre, *right - *left, *down - *up, top_left_is_black, radius_squares};
}

std::vector<int> Inconsistent(const std::vector<PlanePoint>& points_in) {
  std::vector<PlanePoint> points = points_in;
  std::vector<int> index(points.size());
  for (int i = 0; i < static_cast<int>(index.size()); ++i) index[i] = i;
  std::vector<int> removed;
  while (points.size() > 5) {  // four points always agree
    double worst = 1;
    int worst_at = -1;
    for (int i = 0; i < static_cast<int>(points.size()); ++i) {
      const Eigen::Vector2d at = points[i].board;
      const auto h = LocalHomography(points, at, kReachSquares, i);
      if (!h) continue;  // the others lie on a line
      const auto here = ApplyHomography(*h, at);
      const auto right = ApplyHomography(*h, at + Eigen::Vector2d(1, 0));
      const double square_px = here && right ? (*right - *here).norm() : 0;
      const double tolerance_px = std::max(1.5, 0.06 * square_px);
      const double error = here ? (*here - points[i].image_px).norm() / tolerance_px : 1e9;
      if (error > worst) {
        worst = error;
        worst_at = i;
      }
    }
    if (worst_at < 0) break;
    removed.push_back(index[worst_at]);
    points.erase(points.begin() + worst_at);
    index.erase(index.begin() + worst_at);
  }
  return removed;
}

}  // namespace corners
}  // namespace glint
