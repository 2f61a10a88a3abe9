#include "calib/guidance/clipping.h"

#include <cmath>

#include "calib/corners/local_homography.h"
#include "calib/guidance/coverage.h"

namespace glint {
namespace {

constexpr float kClipped = 0.985f;  // stored value, as for the board's paper
constexpr int kPointsAcross = 96;

}  // namespace

double ClippedShareOfSample(const Photo& photo, const std::vector<CornerObservation>& corners,
                            const std::array<double, 2>& sample_size_mm) {
  if (photo.is_float()) return 0;
  std::vector<PlanePoint> points;
  for (const CornerObservation& corner : corners) {
    points.push_back({corner.position_in_sample_mm, corner.point_px});
  }
  const auto h = FitHomography(points);
  if (!h) return 0;
  const StoredImage& image = photo.image;
  const CoverageGrid grid = MakeCoverageGrid(sample_size_mm, kPointsAcross);
  int inside = 0, clipped = 0;
  for (size_t cell = 0; cell < grid.cells(); ++cell) {
    const auto at = ApplyHomography(*h, grid.Centre_mm(cell));
    if (!at || !(at->x() >= 0 && at->y() >= 0 && at->x() < image.width && at->y() < image.height)) {
      continue;
    }
    const size_t pixel = static_cast<size_t>(at->y()) * image.width + static_cast<size_t>(at->x());
    ++inside;
    bool full = false;
    for (int c = 0; c < 3; ++c) full = full || image.at(pixel, c) >= kClipped;
    if (full) ++clipped;
  }
  return inside == 0 ? 0 : static_cast<double>(clipped) / inside;
}

}  // namespace glint
