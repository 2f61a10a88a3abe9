#include "calib/chart/measure_chart.h"

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>

#include "calib/chart/plane_map.h"

namespace glint {
namespace {

constexpr double kShareRead = 0.5;  // of a patch's side

double MeanOfMiddleHalf(std::vector<float>* values) {
  std::sort(values->begin(), values->end());
  const size_t quarter = values->size() / 4;
  double sum = 0;
  for (size_t i = quarter; i < values->size() - quarter; ++i) sum += (*values)[i];
  return sum / static_cast<double>(values->size() - 2 * quarter);
}

// Pixels whose centres lie in the square, which the picture shows as a quadrilateral.
struct PixelBox {
  Eigen::Vector2d least, most;
};

PixelBox BoxOf(const Eigen::Matrix3d& image_from_chart, const Eigen::Vector2d& top_left,
               const Eigen::Vector2d& bottom_right) {
  PixelBox box{Eigen::Vector2d::Constant(1e9), Eigen::Vector2d::Constant(-1e9)};
  for (const Eigen::Vector2d& corner : CornersOf(top_left, bottom_right)) {
    const Eigen::Vector2d at = Mapped(image_from_chart, corner);
    box.least = box.least.cwiseMin(at);
    box.most = box.most.cwiseMax(at);
  }
  return box;
}

template <class Reader>
PatchReading Read(const Reader& reader, const LinearPhoto& photo, const ChartPatch& patch,
                  const Eigen::Matrix3d& image_from_chart,
                  const Eigen::Matrix3d& chart_from_image) {
  const double half = kShareRead * patch.half_side;
  const Eigen::Vector2d reach(half, half);
  const PixelBox box = BoxOf(image_from_chart, patch.centre - reach, patch.centre + reach);
  PatchReading reading;
  reading.inside =
      box.least.minCoeff() >= 0 && box.most.x() <= photo.width() && box.most.y() <= photo.height();
  if (!reading.inside) return reading;
  std::array<std::vector<float>, 3> values;
  size_t clipped = 0;
  for (int y = static_cast<int>(box.least.y()); y < box.most.y(); ++y) {
    for (int x = static_cast<int>(box.least.x()); x < box.most.x(); ++x) {
      const Eigen::Vector2d at = Mapped(chart_from_image, Eigen::Vector2d(x + 0.5, y + 0.5));
      if ((at - patch.centre).lpNorm<Eigen::Infinity>() > half) continue;
      const auto pixel = reader.At(static_cast<size_t>(y) * photo.width() + x);
      const bool black = *std::min_element(pixel.rgb.begin(), pixel.rgb.end()) == 0;
      clipped += pixel.saturated || black;
      for (int c = 0; c < 3; ++c) values[c].push_back(pixel.rgb[c]);
    }
  }
  reading.pixels = static_cast<int>(values[0].size());
  reading.clipped = 4 * clipped > values[0].size();
  if (reading.pixels == 0) return reading;
  for (int c = 0; c < 3; ++c) reading.rgb[c] = MeanOfMiddleHalf(&values[c]);
  return reading;
}

}  // namespace

std::vector<PatchReading> MeasureChart(const LinearPhoto& photo, const Chart& chart,
                                       const ChartCorners& corners_px) {
  const Eigen::Matrix3d map =
      MapOfFourPoints(CornersOf(Eigen::Vector2d(0, 0), chart.size), corners_px);
  const Eigen::Matrix3d inverse = map.inverse();
  std::vector<PatchReading> readings;
  photo.Visit([&](const auto& reader) {
    for (const ChartPatch& patch : chart.patches) {
      readings.push_back(Read(reader, photo, patch, map, inverse));
    }
  });
  return readings;
}

}  // namespace glint
