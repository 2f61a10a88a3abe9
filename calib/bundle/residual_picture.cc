#include "calib/bundle/residual_picture.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "base/canvas/canvas.h"

namespace glint {
namespace {

// Colours of equal brightness round the hue circle, by the golden angle: neighbours differ.
cv::Scalar PhotoColour(int index) {
  const double hue = std::fmod(index * 0.381966, 1.0) * 6;
  const double x = 1 - std::abs(std::fmod(hue, 2.0) - 1);
  const double rgb[6][3] = {{1, x, 0}, {x, 1, 0}, {0, 1, x}, {0, x, 1}, {x, 0, 1}, {1, 0, x}};
  const auto& c = rgb[std::min(5, static_cast<int>(hue))];
  return {200 * c[0], 160 * c[1], 220 * c[2]};
}

// OpenCV draws with 4 fractional bits; its (0, 0) is the centre of the top-left pixel.
constexpr int kShift = 4;
cv::Point Fixed(double x, double y) {
  const auto bounded = [](double v) { return std::clamp(v, -20000.0, 20000.0); };
  return {static_cast<int>(std::lround((bounded(x) - 0.5) * (1 << kShift))),
          static_cast<int>(std::lround((bounded(y) - 0.5) * (1 << kShift)))};
}

void DrawPhoto(const PhotoEstimate& photo, int index, double scale, double lengthening,
               cv::Mat* canvas) {
  for (const CornerResidual& corner : photo.corners) {
    const Eigen::Vector2d from = (corner.point_px - corner.residual_px) * scale;
    if (!corner.inlier || !photo.rejected.empty()) {
      const Eigen::Vector2d at = corner.point_px * scale;
      for (const double sign : {-1.0, 1.0}) {
        cv::line(*canvas, Fixed(at.x() - 4, at.y() - 4 * sign),
                 Fixed(at.x() + 4, at.y() + 4 * sign), cv::Scalar(150, 150, 150), 1, cv::LINE_AA,
                 kShift);
      }
      continue;
    }
    const Eigen::Vector2d to = from + corner.residual_px * lengthening;
    const cv::Scalar colour = PhotoColour(index);
    cv::line(*canvas, Fixed(from.x(), from.y()), Fixed(to.x(), to.y()), colour, 1, cv::LINE_AA,
             kShift);
    cv::circle(*canvas, Fixed(from.x(), from.y()), 2 << kShift, colour, cv::FILLED, cv::LINE_AA,
               kShift);
  }
}

}  // namespace

Image ResidualPicture(const BundleResult& result, int camera, int width_px) {
  const Camera& of = result.cameras[camera].camera;
  const double scale = static_cast<double>(width_px) / of.width_px;
  const int height = std::max(1, static_cast<int>(std::lround(of.height_px * scale)));
  const int foot = 34;
  cv::Mat canvas(height + foot, width_px, CV_8UC3, cv::Scalar(255, 255, 255));
  const double lengthening = width_px / 40.0 / std::max(result.rms_px, 1e-6);
  for (size_t i = 0; i < result.photos.size(); ++i) {
    if (result.photos[i].camera != camera) continue;
    DrawPhoto(result.photos[i], static_cast<int>(i), scale, lengthening, &canvas);
  }
  cv::line(canvas, {0, height}, {width_px, height}, cv::Scalar(0, 0, 0));
  const std::string text = fmt::format(
      "camera {}: {} photos, {:.3f} px RMS; arrows magnified {:.0f} times; grey: rejected", camera,
      result.cameras[camera].photos, result.rms_px, lengthening / scale);
  cv::putText(canvas, text, {10, height + 23}, cv::FONT_HERSHEY_SIMPLEX, 0.55,
              cv::Scalar(40, 40, 40), 1, cv::LINE_AA);
  return ImageOf(canvas);
}

}  // namespace glint
