#include "calib/chart/find_chart.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "base/colour/srgb.h"
#include "calib/chart/chart.h"
#include "calib/chart/chart_kinds.h"
#include "calib/chart/plane_map.h"

namespace glint {
namespace {

// The level that the brightest hundredth of a linear photograph lies above: what shows as white.
float WhiteLevel(const Image& image) {
  std::vector<float> green(image.channel(1).begin(), image.channel(1).end());
  const auto at = green.begin() + static_cast<std::ptrdiff_t>(green.size() * 99 / 100);
  std::nth_element(green.begin(), at, green.end());
  return std::max(*at, 1e-6f);
}

// As a screen would show it: mcc wants eight bits.
cv::Mat Shown(const Photo& photo, bool linear) {
  const Image image = photo.image.Planes();
  const float white = linear ? WhiteLevel(image) : 1;
  cv::Mat shown(image.height, image.width, CV_8UC3);
  for (size_t i = 0; i < image.pixels(); ++i) {
    for (int c = 0; c < 3; ++c) {
      const float value = image.channel(2 - c)[i] / white;  // blue first
      const float stored = linear ? ClampedSrgb(value) : std::clamp(value, 0.0f, 1.0f);
      shown.data[3 * i + c] = static_cast<unsigned char>(std::lround(255 * stored));
    }
  }
  return shown;
}

bool Clockwise(const ChartCorners& corners) {
  const Eigen::Vector2d across = corners[2] - corners[0], up = corners[3] - corners[1];
  return across.x() * up.y() - across.y() * up.x() > 0;  // y points down
}

// OpenCV shares the detection out to threads, which add what they find in any order.
class OneThread {
 public:
  OneThread() : before_(cv::getNumThreads()) { cv::setNumThreads(1); }
  ~OneThread() { cv::setNumThreads(before_); }
  OneThread(const OneThread&) = delete;
  OneThread& operator=(const OneThread&) = delete;

 private:
  int before_;
};

}  // namespace

std::optional<ChartCorners> FindChart(const Photo& photo, bool linear, const std::string& kind_name,
                                      int longest_px) {
  const auto kind = std::find_if(ChartKinds().begin(), ChartKinds().end(),
                                 [&](const ChartKind& known) { return known.name == kind_name; });
  const OneThread deterministic;
  cv::Mat shown = Shown(photo, linear);
  const double scale =
      std::min(1.0, static_cast<double>(longest_px) / std::max(shown.cols, shown.rows));
  if (scale < 1) cv::resize(shown, shown, cv::Size(), scale, scale, cv::INTER_AREA);
  const auto detector = cv::mcc::CCheckerDetector::create();
  if (!detector->process(shown, kind->detected_as)) return std::nullopt;
  const auto found = detector->getBestColorChecker();
  if (found.empty()) return std::nullopt;
  const std::vector<cv::Point2f> outline = found->getBox();
  if (outline.size() != 4) return std::nullopt;
  ChartCorners box;
  for (size_t i = 0; i < 4; ++i) {
    const cv::Point2f& at = outline[i];
    box[i] = Eigen::Vector2d(at.x + 0.5, at.y + 0.5) / scale;
  }
  if (!Clockwise(box)) std::swap(box[1], box[3]);  // mcc numbers some kinds' corners the other way
  const Eigen::Vector2d margin(kind->margin, kind->margin);
  const Eigen::Vector2d size = ChartOfKind(kind_name)->size;
  const Eigen::Matrix3d map = MapOfFourPoints(CornersOf(-margin, size + margin), box);
  ChartCorners corners = CornersOf(Eigen::Vector2d(0, 0), size);
  for (Eigen::Vector2d& corner : corners) corner = Mapped(map, corner);
  return corners;
}

}  // namespace glint
