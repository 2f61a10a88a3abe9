#include "calib/validation/diagnosis_picture.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <opencv2/imgproc.hpp>

#include "base/canvas/canvas.h"

namespace glint {
namespace {

const cv::Scalar kInk(40, 40, 40), kFrame(190, 190, 190), kArrow(200, 60, 30), kAxis(20, 90, 200);

cv::Point At(const Eigen::Vector2d& point) {
  const auto bounded = [](double v) { return std::clamp(std::isfinite(v) ? v : 0, -1e4, 1e4); };
  return {static_cast<int>(std::lround(bounded(point.x()))),
          static_cast<int>(std::lround(bounded(point.y())))};
}

void Write(const std::string& text, const cv::Point& at, double size, cv::Mat* canvas) {
  cv::putText(*canvas, text, at, cv::FONT_HERSHEY_SIMPLEX, size, kInk, 1, cv::LINE_AA);
}

// White at 0, red above, blue below.
cv::Scalar HeightColour(double share) {
  const double s = std::clamp(share, -1.0, 1.0);
  const double fade = 255 * (1 - std::abs(s));
  return s > 0 ? cv::Scalar(255 - 35 * s, fade, fade) : cv::Scalar(fade, fade, 255 + 35 * s);
}

double RootMean(double sum, size_t n) { return std::sqrt(sum / std::max<size_t>(1, n)); }

struct Tile {
  cv::Rect picture;
  double scale;  // of the photo
};

void DrawPhoto(const PhotoEstimate& photo, const PhotoPattern& pattern, double lengthening,
               const Tile& tile, cv::Mat* canvas) {
  cv::rectangle(*canvas, tile.picture, kFrame);
  const Eigen::Vector2d origin(tile.picture.x, tile.picture.y);
  for (const CornerResidual& corner : photo.corners) {
    if (!corner.inlier) continue;
    const Eigen::Vector2d from = origin + (corner.point_px - corner.residual_px) * tile.scale;
    cv::line(*canvas, At(from), At(from + corner.residual_px * lengthening), kArrow, 1,
             cv::LINE_AA);
    cv::circle(*canvas, At(from), 1, kArrow, cv::FILLED, cv::LINE_AA);
  }
  const Eigen::Vector2d middle =
      origin + 0.5 * Eigen::Vector2d(tile.picture.width, tile.picture.height);
  const double angle = pattern.axis_deg * std::numbers::pi / 180;
  const Eigen::Vector2d axis(std::cos(angle), std::sin(angle)), across(-axis.y(), axis.x());
  const Eigen::Vector2d along = axis * pattern.mean_length_px * lengthening;
  const Eigen::Vector2d side = across * pattern.across_px * lengthening;
  cv::line(*canvas, At(middle - along), At(middle + along), kAxis, 2, cv::LINE_AA);
  cv::line(*canvas, At(middle - side), At(middle + side), kAxis, 2, cv::LINE_AA);
  std::string name = photo.name;
  if (name.size() > 24) name = ".." + name.substr(name.size() - 22);
  const cv::Point below(tile.picture.x, tile.picture.y + tile.picture.height + 14);
  Write(fmt::format("{}  {:.2f} px", name, photo.rms_px), below, 0.4, canvas);
  const std::string found = pattern.moved_while_read      ? "moved while read"
                            : pattern.scattered_on_a_line ? "blurred by motion"
                                                          : "";
  Write(found, below + cv::Point(0, 15), 0.4, canvas);
}

}  // namespace

Image PlacesPicture(const Diagnosis& diagnosis, int width_px) {
  constexpr int kMargin = 60, kFoot = 50;
  Eigen::Vector2d low(1e9, 1e9), high(-1e9, -1e9);
  double plane = 0, height = 0;
  for (const PlaceMean& place : diagnosis.places) {
    low = low.cwiseMin(place.position_in_sample_mm);
    high = high.cwiseMax(place.position_in_sample_mm);
    plane += place.offset_mm.head<2>().squaredNorm();
    height += place.offset_mm.z() * place.offset_mm.z();
  }
  if (diagnosis.places.empty()) low = high = Eigen::Vector2d::Zero();
  const Eigen::Vector2d size = (high - low).cwiseMax(1e-3);
  const double scale = (width_px - 2 * kMargin) / std::max(size.x(), size.y());
  const int rows = static_cast<int>(std::lround(size.y() * scale)) + 2 * kMargin;
  cv::Mat canvas(rows + kFoot, width_px, CV_8UC3, cv::Scalar(255, 255, 255));
  const double plane_rms = RootMean(plane, diagnosis.places.size());
  const double height_rms = RootMean(height, diagnosis.places.size());
  const double lengthening = 20 / std::max(plane_rms, 1e-6);  // an offset of the RMS: 20 px
  for (const PlaceMean& place : diagnosis.places) {
    const Eigen::Vector2d at(kMargin + (place.position_in_sample_mm.x() - low.x()) * scale,
                             kMargin + (high.y() - place.position_in_sample_mm.y()) * scale);
    cv::circle(canvas, At(at), 9,
               HeightColour(place.offset_mm.z() / std::max(2 * height_rms, 1e-6)), cv::FILLED,
               cv::LINE_AA);
    cv::circle(canvas, At(at), 9, kFrame, 1, cv::LINE_AA);
    const Eigen::Vector2d arrow(place.offset_mm.x(), -place.offset_mm.y());
    cv::arrowedLine(canvas, At(at), At(at + lengthening * arrow), kInk, 1, cv::LINE_AA, 0, 0.25);
  }
  Write(
      fmt::format("corners' mean offset on the board: arrows magnified {:.0f} times, RMS {:.4f} mm",
                  lengthening / scale, plane_rms),
      {10, rows + 18}, 0.5, &canvas);
  Write(fmt::format("discs: above (red) or below (blue) the board's plane, full at {:.3f} mm",
                    2 * height_rms),
        {10, rows + 38}, 0.5, &canvas);
  return ImageOf(canvas);
}

Image PhotosPicture(const BundleResult& result, const Diagnosis& diagnosis, int camera,
                    int width_px) {
  constexpr int kColumns = 4, kGap = 12, kText = 38, kFoot = 30;
  constexpr size_t kMost = 60;
  std::vector<size_t> photos;
  for (size_t i = 0; i < result.photos.size() && photos.size() < kMost; ++i) {
    if (result.photos[i].camera == camera && result.photos[i].rejected.empty()) photos.push_back(i);
  }
  const Camera& of = result.cameras[camera].camera;
  const int side = (width_px - kGap) / kColumns - kGap;
  const double scale = static_cast<double>(side) / of.width_px;
  const int high = std::clamp(static_cast<int>(std::lround(of.height_px * scale)), 1, 4 * side);
  const int lines = static_cast<int>((photos.size() + kColumns - 1) / kColumns);
  cv::Mat canvas(std::max(1, lines) * (high + kText + kGap) + kGap + kFoot, width_px, CV_8UC3,
                 cv::Scalar(255, 255, 255));
  const double lengthening = side / 24.0 / std::max(result.rms_px, 1e-6);
  for (size_t k = 0; k < photos.size(); ++k) {
    const int column = static_cast<int>(k) % kColumns, line = static_cast<int>(k) / kColumns;
    const Tile tile{
        {kGap + column * (side + kGap), kGap + line * (high + kText + kGap), side, high}, scale};
    DrawPhoto(result.photos[photos[k]], diagnosis.photos[photos[k]], lengthening, tile, &canvas);
  }
  Write(
      fmt::format("camera {}: residuals magnified {:.0f} times; cross: how far they scatter along "
                  "and across their main direction",
                  camera, lengthening / scale),
      {kGap, canvas.rows - 10}, 0.5, &canvas);
  return ImageOf(canvas);
}

}  // namespace glint
