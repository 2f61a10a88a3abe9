#include "datasets/statistics/comparison_picture.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "base/canvas/canvas.h"
#include "datasets/statistics/distance.h"

namespace glint {
namespace {

constexpr int kColumns = 6;
constexpr int kPanelWidth = 300, kPanelHeight = 190;
constexpr int kMargin = 12, kTitle = 22, kFoot = 18;

const cv::Scalar kInk(60, 60, 60), kFrame(200, 200, 200);
const cv::Scalar kSideColors[2] = {{230, 120, 20}, {30, 90, 200}};  // real, generated

struct Point {
  double x, y;
};

// A panel with axes of its own; y grows upward.
class Panel {
 public:
  Panel(cv::Mat* canvas, size_t index, Point low, Point high)
      : canvas_(canvas), low_(low), high_(high) {
    const int column = static_cast<int>(index) % kColumns, row = static_cast<int>(index) / kColumns;
    corner_ = cv::Point(column * kPanelWidth + kMargin, row * kPanelHeight + kTitle);
    size_ = cv::Size(kPanelWidth - 2 * kMargin, kPanelHeight - kTitle - kFoot);
    cv::rectangle(*canvas_, cv::Rect(corner_, size_), kFrame);
  }

  void Title(const Distance& d) {
    Text(fmt::format("{} {}", d.group == "trait" ? "" : d.group, d.name), {0, -6}, kInk);
    Text(fmt::format("KS {:.2f}", d.ks), {size_.width - 58, -6}, kInk);
  }

  void Ends(const std::string& low, const std::string& high) {
    Text(low, {0, size_.height + 13}, kInk);
    Text(high, {size_.width - 8 * static_cast<int>(high.size()), size_.height + 13}, kInk);
  }

  void Line(const std::vector<Point>& points, int side, int thickness) {
    std::vector<cv::Point> pixels;
    for (const Point& p : points) pixels.push_back(Place(p));
    cv::polylines(*canvas_, pixels, false, kSideColors[side], thickness, cv::LINE_AA);
  }

 private:
  cv::Point Place(const Point& p) const {
    const double u = std::clamp((p.x - low_.x) / (high_.x - low_.x), 0.0, 1.0);
    const double v = std::clamp((p.y - low_.y) / (high_.y - low_.y), 0.0, 1.0);
    return corner_ + cv::Point(static_cast<int>(std::lround(u * size_.width)),
                               static_cast<int>(std::lround((1 - v) * size_.height)));
  }
  void Text(const std::string& text, cv::Point at, const cv::Scalar& color) {
    cv::putText(*canvas_, text, corner_ + at, cv::FONT_HERSHEY_SIMPLEX, 0.42, color, 1,
                cv::LINE_AA);
  }

  cv::Mat* canvas_;
  Point low_, high_;
  cv::Point corner_;
  cv::Size size_;
};

void DrawChannel(const Comparison& c, const Distance& d, Channel channel, size_t index,
                 cv::Mat* canvas) {
  const ChannelInfo& info = InfoOf(channel);
  const Population* sides[2] = {&c.real, &c.generated};
  // Single bins, such as that of F0 .04, may tower; show what the others do.
  Panel panel(canvas, index, {info.low, 0}, {info.high, 0.12});
  for (int side = 0; side < 2; ++side) {
    const auto histogram = sides[side]->MeanHistogram(channel);
    std::vector<Point> line;
    for (int bin = 0; bin < kHistogramBins; ++bin) {
      const double x = info.low + (info.high - info.low) * (bin + 0.5) / kHistogramBins;
      line.push_back({x, histogram[static_cast<size_t>(bin)]});
    }
    panel.Line(line, side, 1);
  }
  panel.Title(d);
  panel.Ends(fmt::format("{:g}", info.low), fmt::format("{:g} {}", info.high, info.unit));
}

void DrawSpectrum(const Comparison& c, const Distance& d, SpectrumOf spectrum, size_t index,
                  cv::Mat* canvas) {
  const Population* sides[2] = {&c.real, &c.generated};
  Panel panel(canvas, index, {0, -12}, {kSpectrumBands - 1, 0});
  for (int side = 0; side < 2; ++side) {
    for (const double share : {0.1, 0.5, 0.9}) {
      std::vector<Point> line;
      for (int band = 0; band < kSpectrumBands; ++band) {
        line.push_back(
            {static_cast<double>(band), Quantile(sides[side]->LogPower(spectrum, band), share)});
      }
      panel.Line(line, side, share == 0.5 ? 2 : 1);
    }
  }
  panel.Title(d);
  panel.Ends("1 cycle, 1e-12 to 1", "128");
}

void DrawTrait(const Comparison& c, const Distance& d, Trait trait, size_t index, cv::Mat* canvas) {
  const TraitInfo& info = InfoOf(trait);
  const Population* sides[2] = {&c.real, &c.generated};
  Panel panel(canvas, index, {info.low, 0}, {info.high, 1});
  for (int side = 0; side < 2; ++side) {
    std::vector<double> values = sides[side]->Trait(trait);
    std::sort(values.begin(), values.end());
    std::vector<Point> line{{info.low, 0}};
    for (size_t i = 0; i < values.size(); ++i) {
      line.push_back({values[i], line.back().y});
      line.push_back({values[i], static_cast<double>(i + 1) / static_cast<double>(values.size())});
    }
    line.push_back({info.high, line.back().y});
    panel.Line(line, side, 1);
  }
  panel.Title(d);
  panel.Ends(fmt::format("{:g}", info.low), fmt::format("{:g}", info.high));
}

}  // namespace

Image DrawComparison(const Comparison& comparison) {
  const int rows = static_cast<int>(comparison.distances.size() + kColumns - 1) / kColumns;
  cv::Mat canvas(rows * kPanelHeight, kColumns * kPanelWidth, CV_8UC3, cv::Scalar::all(255));
  size_t index = 0;
  for (int i = 0; i < kChannels; ++i, ++index) {
    DrawChannel(comparison, comparison.distances[index], static_cast<Channel>(i), index, &canvas);
  }
  for (int i = 0; i < kSpectra; ++i, ++index) {
    DrawSpectrum(comparison, comparison.distances[index], static_cast<SpectrumOf>(i), index,
                 &canvas);
  }
  for (int i = 0; i < kTraits; ++i, ++index) {
    DrawTrait(comparison, comparison.distances[index], static_cast<Trait>(i), index, &canvas);
  }
  return ImageOf(canvas);
}

}  // namespace glint
