#include "calib/guidance/coverage_picture.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "base/canvas/canvas.h"

namespace glint {
namespace {

constexpr int kCell_px = 14, kFoot_px = 62, kLeastWidth_px = 400;
constexpr double kFarthest_deg = 30;

// Viridis from its bright end, BGR.
cv::Scalar Colour(double angle_deg) {
  constexpr std::array<std::array<double, 3>, 5> kStops{{{0.993, 0.906, 0.144},
                                                         {0.369, 0.789, 0.383},
                                                         {0.128, 0.567, 0.551},
                                                         {0.230, 0.322, 0.546},
                                                         {0.267, 0.005, 0.329}}};
  const double place = std::clamp(angle_deg / kFarthest_deg, 0.0, 1.0) * (kStops.size() - 1);
  const size_t i = std::min(static_cast<size_t>(place), kStops.size() - 2);
  const double part = place - static_cast<double>(i);
  cv::Scalar colour;
  for (int c = 0; c < 3; ++c) {
    colour[2 - c] = 255 * (kStops[i][c] + part * (kStops[i + 1][c] - kStops[i][c]));
  }
  return colour;
}

void Write(cv::Mat* canvas, int x, int y, const std::string& text) {
  cv::putText(*canvas, text, {x, y}, cv::FONT_HERSHEY_SIMPLEX, 0.42, cv::Scalar(60, 60, 60), 1,
              cv::LINE_AA);
}

void DrawScale(double highlight_deg, int top, cv::Mat* canvas) {
  const int left = 12, width = 360;
  for (int x = 0; x < width; ++x) {
    const cv::Scalar colour = Colour(kFarthest_deg * x / width);
    cv::line(*canvas, {left + x, top + 8}, {left + x, top + 20}, colour);
  }
  const int mark = left + static_cast<int>(std::lround(width * highlight_deg / kFarthest_deg));
  cv::line(*canvas, {mark, top + 4}, {mark, top + 24}, cv::Scalar(30, 30, 220), 2);
  for (int angle = 0; angle <= static_cast<int>(kFarthest_deg); angle += 10) {
    const int x = left + width * angle / static_cast<int>(kFarthest_deg);
    Write(canvas, x - 6, top + 36, std::to_string(angle));
  }
  Write(canvas, left, top + 54,
        fmt::format("degrees (below {:.0f}: highlight seen); grey: no photograph", highlight_deg));
}

}  // namespace

Image CoveragePicture(const Verdict& verdict) {
  const CoverageGrid& grid = verdict.coverage.grid;
  const int height = grid.rows * kCell_px;
  cv::Mat canvas(height + kFoot_px, std::max(kLeastWidth_px, grid.columns * kCell_px), CV_8UC3,
                 cv::Scalar(255, 255, 255));
  for (size_t cell = 0; cell < grid.cells(); ++cell) {
    const int x = static_cast<int>(cell % grid.columns), y = static_cast<int>(cell / grid.columns);
    const bool shown = verdict.coverage.photos[cell] > 0;
    cv::rectangle(
        canvas, cv::Rect(x * kCell_px, y * kCell_px, kCell_px - 1, kCell_px - 1),
        shown ? Colour(verdict.coverage.least_half_angle_deg[cell]) : cv::Scalar(190, 190, 190),
        cv::FILLED);
  }
  DrawScale(verdict.limits.highlight_deg, height, &canvas);
  cv::cvtColor(canvas, canvas, cv::COLOR_BGR2RGB);
  return ImageOf(canvas);
}

}  // namespace glint
