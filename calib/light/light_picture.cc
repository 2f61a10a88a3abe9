#include "calib/light/light_picture.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "base/canvas/canvas.h"

namespace glint {
namespace {

constexpr int kFoot_px = 22;
constexpr int kColumns = 4;

// RGB, as the canvas holds it.
cv::Scalar Colour(double share) {
  const double s = std::clamp(share, -1.0, 1.0);
  return s < 0 ? cv::Scalar(235 + 205 * s, 235 + 145 * s, 235 + 5 * s)
               : cv::Scalar(235 - 15 * s, 235 - 195 * s, 235 - 195 * s);
}

void DrawPanel(const LightOfPhoto& photo, double scale, double full_percent, cv::Mat panel) {
  for (const LightOfPhoto::Spot& spot : photo.spots) {
    const cv::Point at(static_cast<int>(std::lround(spot.point_px.x() * scale - 0.5)),
                       static_cast<int>(std::lround(spot.point_px.y() * scale - 0.5)));
    if (!spot.inlier) {
      cv::line(panel, at - cv::Point(2, 2), at + cv::Point(2, 2), cv::Scalar(120, 120, 120));
      cv::line(panel, at + cv::Point(-2, 2), at + cv::Point(2, -2), cv::Scalar(120, 120, 120));
      continue;
    }
    cv::circle(panel, at, 2, Colour(100 * spot.relative.mean() / full_percent), cv::FILLED,
               cv::LINE_AA);
  }
}

}  // namespace

Image LightPicture(const LightProblem& problem, const LightEstimate& estimate, double full_percent,
                   int panel_px) {
  const int count = static_cast<int>(estimate.photos.size());
  const int columns = std::max(1, std::min(kColumns, count));
  const int rows = std::max(1, (count + columns - 1) / columns);
  const int side = panel_px + kFoot_px;
  cv::Mat canvas(rows * side + kFoot_px, columns * panel_px, CV_8UC3, cv::Scalar(255, 255, 255));
  const auto write = [&](const std::string& text, int x, int y) {
    cv::putText(canvas, text, {x, y}, cv::FONT_HERSHEY_SIMPLEX, 0.4, cv::Scalar(40, 40, 40), 1,
                cv::LINE_AA);
  };
  for (int i = 0; i < count; ++i) {
    const Camera& camera = problem.cameras[problem.photos[i].camera];
    const double scale =
        static_cast<double>(panel_px - 4) / std::max(camera.width_px, camera.height_px);
    const int x = i % columns * panel_px, y = i / columns * side;
    const cv::Rect place(x, y, static_cast<int>(camera.width_px * scale),
                         static_cast<int>(camera.height_px * scale));
    canvas(place).setTo(cv::Scalar(90, 90, 90));
    DrawPanel(estimate.photos[i], scale, full_percent, canvas(place));
    const LightOfPhoto& photo = estimate.photos[i];
    write(fmt::format("{} {:.2f} % RMS{}", photo.name.substr(photo.name.find_last_of('/') + 1),
                      photo.rms_percent, photo.used ? "" : " (not used)"),
          x + 4, y + place.height + 14);
  }
  write(fmt::format("white paper, seen against predicted: blue -{0:g} %, red +{0:g} %; crosses: "
                    "rejected",
                    full_percent),
        4, canvas.rows - 7);
  return ImageOf(canvas);
}

}  // namespace glint
