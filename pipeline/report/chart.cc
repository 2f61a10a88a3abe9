#include "pipeline/report/chart.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

#include "pipeline/report/html.h"

namespace glint {
namespace {

constexpr double kWidth = 440, kHeight = 240;
constexpr double kLeft = 58, kRight = 12, kTop = 30, kBottom = 36;
constexpr double kLogarithmicSpan = 5;
constexpr const char* kColors[] = {"#175cd3", "#b54708", "#027a48",
                                   "#6941c6", "#c11574", "#475467"};

struct Range {
  double low = std::numeric_limits<double>::infinity();
  double high = -std::numeric_limits<double>::infinity();
  void Add(double value) {
    low = std::min(low, value);
    high = std::max(high, value);
  }
  void Widen() {
    if (high > low) return;
    const double margin = std::max(std::abs(low) * 0.1, 1e-12);
    low -= margin;
    high += margin;
  }
};

std::string Coordinate(double value) {
  char text[32];
  std::snprintf(text, sizeof(text), "%.1f", value);
  return text;
}

// Steps of 1, 2 or 5 times a power of ten, about four in the range.
std::vector<double> LinearTicks(const Range& range) {
  const double rough = (range.high - range.low) / 4;
  const double power = std::pow(10.0, std::floor(std::log10(rough)));
  double step = 10 * power;
  for (const double factor : {5.0, 2.0, 1.0}) {
    if (factor * power >= rough) step = factor * power;
  }
  std::vector<double> ticks;
  for (double i = std::ceil(range.low / step); i * step <= range.high; ++i) {
    ticks.push_back(i == 0 ? 0 : i * step);
  }
  return ticks;
}

std::vector<double> LogarithmicTicks(const Range& range) {
  std::vector<double> ticks;
  for (int power = -15; power <= 15; ++power) {
    for (const double digit : {1.0, 2.0, 5.0}) {
      const double value = digit * std::pow(10.0, power);
      if (value >= range.low && value <= range.high) ticks.push_back(value);
    }
  }
  return ticks;
}

// Maps values to the picture's coordinates.
struct Axes {
  Range x, y;
  bool logarithmic = false;

  double Left(double value) const {
    return kLeft + (value - x.low) / (x.high - x.low) * (kWidth - kLeft - kRight);
  }
  double Top(double value) const {
    const auto scaled = [this](double v) { return logarithmic ? std::log(v) : v; };
    const double share = (scaled(value) - scaled(y.low)) / (scaled(y.high) - scaled(y.low));
    return kHeight - kBottom - share * (kHeight - kTop - kBottom);
  }
};

std::string Text(double x, double y, const std::string& anchor, const std::string& text) {
  return "<text x=\"" + Coordinate(x) + "\" y=\"" + Coordinate(y) + "\" text-anchor=\"" + anchor +
         "\">" + HtmlText(text) + "</text>";
}

std::string AxesSvg(const Axes& axes, const Chart& chart) {
  std::string svg;
  for (const double tick : axes.logarithmic ? LogarithmicTicks(axes.y) : LinearTicks(axes.y)) {
    const std::string top = Coordinate(axes.Top(tick));
    svg += "<line x1=\"" + Coordinate(kLeft) + "\" x2=\"" + Coordinate(kWidth - kRight) +
           "\" y1=\"" + top + "\" y2=\"" + top + "\" stroke=\"#e4e7ec\"/>";
    svg += Text(kLeft - 6, axes.Top(tick) + 4, "end", NumberText(tick));
  }
  for (const double tick : LinearTicks(axes.x)) {
    svg += Text(axes.Left(tick), kHeight - kBottom + 15, "middle", NumberText(tick));
  }
  svg += Text((kLeft + kWidth - kRight) / 2, kHeight - 5, "middle", chart.x_label);
  return svg + "<text x=\"4\" y=\"14\" style=\"font-weight:600;fill:#1d2129\">" +
         HtmlText(chart.title) + "</text>";
}

std::string LineSvg(const Axes& axes, const ChartLine& line, const char* color) {
  std::string points;
  for (size_t i = 0; i < line.x.size(); ++i) {
    if (!std::isfinite(line.x[i]) || !std::isfinite(line.y[i])) continue;
    points += Coordinate(axes.Left(line.x[i])) + "," + Coordinate(axes.Top(line.y[i])) + " ";
  }
  return "<polyline fill=\"none\" stroke=\"" + std::string(color) +
         "\" stroke-width=\"1.5\" stroke-linejoin=\"round\" points=\"" + points + "\"/>";
}

}  // namespace

std::string ChartSvg(const Chart& chart) {
  Axes axes;
  size_t points = 0;
  for (const ChartLine& line : chart.lines) {
    for (size_t i = 0; i < line.x.size(); ++i) {
      if (!std::isfinite(line.x[i]) || !std::isfinite(line.y[i])) continue;
      axes.x.Add(line.x[i]);
      axes.y.Add(line.y[i]);
      ++points;
    }
  }
  if (points < 2) return "";
  axes.x.Widen();
  axes.y.Widen();
  axes.logarithmic =
      chart.may_be_logarithmic && axes.y.low > 0 && axes.y.high > kLogarithmicSpan * axes.y.low;
  std::string svg = "<svg width=\"" + Coordinate(kWidth) + "\" height=\"" + Coordinate(kHeight) +
                    "\" viewBox=\"0 0 " + Coordinate(kWidth) + " " + Coordinate(kHeight) +
                    "\" role=\"img\" aria-label=\"" + HtmlText(chart.title) + "\">";
  svg += AxesSvg(axes, chart);
  double legend = kLeft + 8;
  for (size_t i = 0; i < chart.lines.size(); ++i) {
    const char* color = kColors[i % std::size(kColors)];
    svg += LineSvg(axes, chart.lines[i], color);
    if (chart.lines.size() < 2) continue;
    svg += "<text x=\"" + Coordinate(legend) + "\" y=\"" + Coordinate(kTop + 2) +
           "\" style=\"fill:" + color + "\">" + HtmlText(chart.lines[i].name) + "</text>";
    legend += 14 + 6.5 * static_cast<double>(chart.lines[i].name.size());
  }
  return svg + "</svg>\n";
}

}  // namespace glint
