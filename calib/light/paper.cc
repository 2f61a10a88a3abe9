#include "calib/light/paper.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "calib/corners/local_homography.h"

namespace glint {
namespace {

constexpr float kClipped = 0.985f;       // stored value
constexpr double kLeastRadius_px = 1.5;  // of plain paper round a spot, blur taken off

struct Mean {
  Eigen::Vector3d radiance;
  int pixels;
};

// Mean linear radiance over a disc; nullopt: not wholly in the picture, or clipped.
std::optional<Mean> DiscMean(const Photo& photo, Encoding encoding,
                             const Eigen::Vector2d& centre_px, double radius_px) {
  const StoredImage& image = photo.image;
  const int x0 = static_cast<int>(std::floor(centre_px.x() - radius_px));
  const int x1 = static_cast<int>(std::floor(centre_px.x() + radius_px));
  const int y0 = static_cast<int>(std::floor(centre_px.y() - radius_px));
  const int y1 = static_cast<int>(std::floor(centre_px.y() + radius_px));
  if (x0 < 0 || y0 < 0 || x1 >= image.width || y1 >= image.height) return std::nullopt;
  Eigen::Vector3d sum(0, 0, 0);
  int count = 0;
  for (int y = y0; y <= y1; ++y) {
    for (int x = x0; x <= x1; ++x) {
      if ((Eigen::Vector2d(x + 0.5, y + 0.5) - centre_px).norm() > radius_px) continue;
      for (int c = 0; c < 3; ++c) {
        const float stored = image.at(static_cast<size_t>(y) * image.width + x, c);
        if (!photo.is_float() && stored >= kClipped) return std::nullopt;
        sum[c] += LinearFromEncoded(encoding, stored, c);
      }
      ++count;
    }
  }
  if (count == 0) return std::nullopt;
  const Eigen::Vector3f mean = (sum / count).cast<float>();
  const auto rec709 = photo.colour.rec709_from_rgb({mean[0], mean[1], mean[2]});
  return Mean{{rec709[0], rec709[1], rec709[2]}, count};
}

}  // namespace

std::vector<PaperSample> SamplePaper(const Photo& photo, Encoding encoding, const Board& board,
                                     const std::vector<PaperSpot>& spots,
                                     const std::vector<CornerObservation>& corners) {
  std::vector<PlanePoint> points;
  for (const CornerObservation& corner : corners) {
    points.push_back({SquaresFromSample(board, corner.position_in_sample_mm), corner.point_px});
  }
  std::vector<PaperSample> samples;
  for (const PaperSpot& spot : spots) {
    const bool near = std::any_of(points.begin(), points.end(), [&](const PlanePoint& point) {
      return (point.board - spot.squares).norm() <= 1;
    });
    if (!near) continue;
    const auto h = LocalHomography(points, spot.squares, 1.5);
    if (!h) continue;
    const auto at = ApplyHomography(*h, spot.squares);
    const auto right = ApplyHomography(*h, spot.squares + Eigen::Vector2d(spot.radius_squares, 0));
    const auto down = ApplyHomography(*h, spot.squares + Eigen::Vector2d(0, spot.radius_squares));
    if (!at || !right || !down) continue;
    // Two thirds of the way to the next ink is left to blur.
    const double plain_px = std::min((*right - *at).norm(), (*down - *at).norm());
    if (plain_px < 2 * kLeastRadius_px) continue;
    const double radius_px = std::min(12.0, std::max(kLeastRadius_px, plain_px / 3));
    if (const auto mean = DiscMean(photo, encoding, *at, radius_px)) {
      samples.push_back({GridPointInSample(board, spot.squares.x(), spot.squares.y()),
                         mean->radiance, spot.block, mean->pixels, plain_px});
    }
  }
  return samples;
}

}  // namespace glint
