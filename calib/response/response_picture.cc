#include "calib/response/response_picture.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <opencv2/imgproc.hpp>
#include <string>

#include "base/canvas/canvas.h"
#include "base/linearize/encoding.h"

namespace glint {
namespace {

constexpr int kShift = 4, kMargin_px = 44;
constexpr double kDecades = 3, kStops = 2;  // shown
using Curve = std::function<double(double stored)>;

class Plot {
 public:
  Plot(int side_px, int left_px, cv::Mat* canvas)
      : side_(side_px), left_(left_px), canvas_(canvas) {}

  cv::Point At(double x, double y) const {
    const double px = left_ + kMargin_px + x * (side_ - 2 * kMargin_px);
    const double py = side_ - kMargin_px - y * (side_ - 2 * kMargin_px);
    return {static_cast<int>(std::lround(px * (1 << kShift))),
            static_cast<int>(std::lround(py * (1 << kShift)))};
  }
  void Line(double x0, double y0, double x1, double y1, const cv::Scalar& colour, int width) const {
    cv::line(*canvas_, At(x0, y0), At(x1, y1), colour, width, cv::LINE_AA, kShift);
  }
  void Text(double x, double y, const std::string& text) const {
    const cv::Point at = At(x, y);
    cv::putText(*canvas_, text, {at.x >> kShift, at.y >> kShift}, cv::FONT_HERSHEY_SIMPLEX, 0.36,
                cv::Scalar(70, 70, 70), 1, cv::LINE_AA);
  }
  // `f` maps the share of the x axis to that of the y axis.
  void Draw(const Curve& f, const cv::Scalar& colour, int width) const {
    constexpr int kSteps = 300;
    for (int i = 0; i < kSteps; ++i) {
      const double x0 = static_cast<double>(i) / kSteps, x1 = static_cast<double>(i + 1) / kSteps;
      const double y0 = f(x0), y1 = f(x1);
      if (std::min(y0, y1) < 0 || std::max(y0, y1) > 1) continue;
      Line(x0, y0, x1, y1, colour, width);
    }
  }

 private:
  int side_, left_;
  cv::Mat* canvas_;
};

const cv::Scalar kChannelColours[] = {{205, 40, 40}, {30, 150, 50}, {40, 70, 215}};

void DrawCurves(const ResponseCurve& curve, const Plot& plot) {
  for (int decade = 0; decade <= static_cast<int>(kDecades); ++decade) {
    const double at = decade / kDecades;
    plot.Line(0, at, 1, at, cv::Scalar(225, 225, 225), 1);
    plot.Text(-0.1, at - 0.01, decade == 3 ? "1" : "1e-" + std::to_string(3 - decade));
  }
  const auto log_share = [](double v) { return 1 + std::log10(std::max(v, 1e-9)) / kDecades; };
  const auto named = [&](Encoding::Kind kind, int grey) {
    plot.Draw([&](double v) { return log_share(LinearFromEncoded(kind, static_cast<float>(v))); },
              cv::Scalar(grey, grey, grey), 1);
  };
  named(Encoding::kSrgb, 185);
  named(Encoding::kGamma22, 110);
  for (int c = 0; c < 3; ++c) {
    plot.Draw([&](double v) { return log_share(curve.Linear(c, static_cast<float>(v))); },
              kChannelColours[c], 2);
  }
  plot.Text(0, 1.03, "linear value over stored value 0 to 255");
  plot.Text(0.45, 0.08, "grey: gamma 2.2; light grey: sRGB");
}

void DrawDifference(const ResponseCurve& curve, const Plot& plot) {
  for (int stop = -static_cast<int>(kStops); stop <= static_cast<int>(kStops); ++stop) {
    const double at = 0.5 + 0.5 * stop / kStops;
    plot.Line(0, at, 1, at, cv::Scalar(225, 225, 225), stop == 0 ? 2 : 1);
    plot.Text(-0.08, at - 0.01, std::to_string(stop));
  }
  for (int c = 0; c < 3; ++c) {
    const auto share = [&](double v) {
      const double linear = curve.Linear(c, static_cast<float>(v));
      const double stops = std::log2(std::max(linear, 1e-12)) - 2.2 * std::log2(std::max(v, 1e-6));
      return 0.5 + 0.5 * stops / kStops;
    };
    plot.Draw(share, kChannelColours[c], 2);
  }
  plot.Text(0, 1.03, "difference from gamma 2.2, stops, over stored value");
}

}  // namespace

Image ResponsePicture(const ResponseCurve& curve, int side_px) {
  cv::Mat canvas(side_px, 2 * side_px, CV_8UC3, cv::Scalar(255, 255, 255));
  DrawCurves(curve, Plot(side_px, 0, &canvas));
  DrawDifference(curve, Plot(side_px, side_px, &canvas));
  return ImageOf(canvas);
}

}  // namespace glint
