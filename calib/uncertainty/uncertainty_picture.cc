#include "calib/uncertainty/uncertainty_picture.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "base/canvas/canvas.h"

namespace glint {
namespace {

// Round numbers, each about one and a half times the one before.
std::vector<double> ContourLevels(double largest) {
  std::vector<double> levels;
  if (!(largest > 0)) return levels;
  const int decade = static_cast<int>(std::floor(std::log10(largest)));
  for (int d = decade - 1; d <= decade; ++d) {
    for (const double step : {1.0, 1.5, 2.0, 3.0, 5.0, 7.0}) {
      const double level = step * std::pow(10.0, d);
      if (level < largest) levels.push_back(level);
    }
  }
  constexpr size_t kMost = 8;
  if (levels.size() > kMost) levels.erase(levels.begin(), levels.end() - kMost);
  return levels;
}

double Limit(const std::vector<double>& values) {
  std::vector<double> known;
  for (const double value : values) {
    if (std::isfinite(value)) known.push_back(value);
  }
  if (known.empty()) return 1;
  std::sort(known.begin(), known.end());
  return std::max(1e-9, std::min(known.back(), 4 * known[known.size() / 2]));
}

// The grid's values over the whole picture, linear between the cells' centres.
cv::Mat Spread(const ImageGrid& grid, const std::vector<double>& values, double limit,
               const cv::Size& size) {
  cv::Mat cells(grid.rows, grid.columns, CV_32F);
  for (int j = 0; j < grid.rows; ++j) {
    for (int i = 0; i < grid.columns; ++i) {
      const double value = values[static_cast<size_t>(j) * grid.columns + i];
      cells.at<float>(j, i) =
          static_cast<float>(std::isfinite(value) ? std::min(value, limit) : 3 * limit);
    }
  }
  cv::Mat spread;
  cv::resize(cells, spread, size, 0, 0, cv::INTER_LINEAR);
  return spread;
}

cv::Mat Coloured(const cv::Mat& values, double limit) {
  cv::Mat bytes, colours;
  values.convertTo(bytes, CV_8U, 255 / limit);  // saturates
  cv::applyColorMap(bytes, colours, cv::COLORMAP_VIRIDIS);
  cv::cvtColor(colours, colours, cv::COLOR_BGR2RGB);
  return colours;
}

void DrawContours(const cv::Mat& values, double limit, cv::Mat* canvas) {
  for (const double level : ContourLevels(limit)) {
    const cv::Mat above = values > level;
    std::vector<std::vector<cv::Point>> lines;
    cv::findContours(above, lines, cv::RETR_LIST, cv::CHAIN_APPROX_NONE);
    for (const auto& line : lines) {
      const cv::Point* label = nullptr;
      for (size_t i = 0; i < line.size(); ++i) {
        const cv::Point &a = line[i], &b = line[(i + 1) % line.size()];
        const auto at_edge = [&](const cv::Point& p) {
          return p.x < 2 || p.y < 2 || p.x > values.cols - 3 || p.y > values.rows - 3;
        };
        if (at_edge(a) || at_edge(b)) continue;
        cv::line(*canvas, a, b, {255, 255, 255}, 1, cv::LINE_AA);
        if (line.size() > 60 && a.x > 60 && a.x < values.cols - 90 &&
            (label == nullptr || a.y < label->y)) {
          label = &a;
        }
      }
      if (label == nullptr || label->y < 16) continue;
      cv::putText(*canvas, fmt::format("{:.3g}", level), *label + cv::Point(0, -3),
                  cv::FONT_HERSHEY_SIMPLEX, 0.5, {255, 255, 255}, 1, cv::LINE_AA);
    }
  }
}

}  // namespace

std::vector<Eigen::Vector2d> SeenCorners(const BundleResult& result, int camera) {
  std::vector<Eigen::Vector2d> corners;
  for (const PhotoEstimate& photo : result.photos) {
    if (photo.camera != camera || !photo.rejected.empty()) continue;
    for (const CornerResidual& corner : photo.corners) {
      if (corner.inlier) corners.push_back(corner.point_px);
    }
  }
  return corners;
}

Image MapPicture(const Camera& camera, const ImageGrid& grid, const std::vector<double>& values_px,
                 const std::vector<Eigen::Vector2d>& dots_px, const std::string& text,
                 int width_px) {
  constexpr int kFoot = 34;
  const double scale = static_cast<double>(width_px) / camera.width_px;
  const int height = std::clamp(static_cast<int>(std::lround(camera.height_px * scale)), 1, 20000);
  const double limit = Limit(values_px);
  const cv::Mat spread = Spread(grid, values_px, limit, {width_px, height});
  cv::Mat canvas(height + kFoot, width_px, CV_8UC3, cv::Scalar(255, 255, 255));
  cv::Mat map = canvas.rowRange(0, height);
  Coloured(spread, limit).copyTo(map);
  map.setTo(cv::Scalar(128, 128, 128), spread > 1.5 * limit);
  for (const Eigen::Vector2d& dot : dots_px) {
    cv::circle(map,
               {static_cast<int>(std::lround(dot.x() * scale - 0.5)),
                static_cast<int>(std::lround(dot.y() * scale - 0.5))},
               1, {235, 235, 235}, cv::FILLED, cv::LINE_AA);
  }
  DrawContours(spread, limit, &map);
  cv::putText(canvas, text, {10, height + 23}, cv::FONT_HERSHEY_SIMPLEX, 0.5,
              cv::Scalar(40, 40, 40), 1, cv::LINE_AA);
  return ImageOf(canvas);
}

Image UncertaintyPicture(const BundleResult& result, int camera, const UncertaintyMap& map) {
  const std::string text = fmt::format(
      "camera {}: standard deviation of the projection, px, at {:.0f} mm: centre {:.3f}, median "
      "{:.3f}, largest {:.3f}",
      camera, map.depth_mm, map.centre_px, map.median_px, map.largest_px);
  return MapPicture(result.cameras[camera].camera, map.grid, map.sigma_px,
                    SeenCorners(result, camera), text);
}

}  // namespace glint
