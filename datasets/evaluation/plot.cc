#include "datasets/evaluation/plot.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace glint {
namespace {

constexpr double kPanelWidth = 400, kPanelHeight = 280;
constexpr double kLeft = 70, kRight = 20, kTop = 56, kLegendLine = 18;
constexpr double kBelowNumbers = 52, kBelowCategories = 110;  // tick labels and the axis label
constexpr size_t kLegendColumns = 4;

// Okabe and Ito's, told apart by the colour-blind too; later series have them again, dotted.
constexpr std::array<const char*, 7> kColors{"#0072b2", "#d55e00", "#009e73", "#cc79a7",
                                             "#e69f00", "#56b4e9", "#000000"};

// Stroke of a series: colour and dashes.
std::string Color(const std::vector<PlotSeries>& series, size_t index) {
  const int like = series[index].dashed_like;
  const size_t own = like < 0 ? index : static_cast<size_t>(like);
  return kColors[own % kColors.size()];
}
std::string Dashes(const std::vector<PlotSeries>& series, size_t index) {
  if (series[index].dashed_like >= 0) return " stroke-dasharray=\"7 4\"";
  return index >= kColors.size() ? " stroke-dasharray=\"2 3\"" : "";
}

std::string Escaped(const std::string& text) {
  std::string safe;
  for (const char c : text) {
    if (c == '<')
      safe += "&lt;";
    else if (c == '>')
      safe += "&gt;";
    else if (c == '&')
      safe += "&amp;";
    else if (c == '"')
      safe += "&quot;";
    else
      safe += c;
  }
  return safe;
}

std::string Text(double x, double y, const std::string& text, const std::string& anchor,
                 const std::string& more = "") {
  return fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"{}\"{}>{}</text>\n", x, y,
                     anchor, more, Escaped(text));
}

std::string Line(double x0, double y0, double x1, double y1, const std::string& color) {
  return fmt::format(
      "<line x1=\"{:.1f}\" y1=\"{:.1f}\" x2=\"{:.1f}\" y2=\"{:.1f}\" stroke=\"{}\"/>\n", x0, y0, x1,
      y1, color);
}

double Below(const Plot& plot) {
  return plot.categories.empty() ? kBelowNumbers : kBelowCategories;
}

// One axis: data to [0, 1].
class Axis {
 public:
  Axis(bool log, double low, double high) : log_(log) {
    if (!(low <= high)) low = log ? 0.1 : 0, high = 1;
    low_ = To(low), high_ = To(high);
    const double margin = high_ > low_ ? 0.05 * (high_ - low_) : 0.5;
    low_ -= margin, high_ += margin;
  }
  bool Shows(double value) const { return std::isfinite(value) && (!log_ || value > 0); }
  double At(double value) const { return (To(value) - low_) / (high_ - low_); }

  std::vector<double> Ticks() const { return log_ ? LogTicks() : EvenTicks(low_, high_); }

 private:
  double To(double value) const { return log_ ? std::log10(value) : value; }

  // Powers of ten; where these are few also 2 and 5 of them, and else even steps.
  std::vector<double> LogTicks() const {
    constexpr size_t kFew = 3;
    std::vector<double> ticks = PowerTicks({1});
    if (ticks.size() <= kFew) ticks = PowerTicks({1, 2, 5});
    if (ticks.size() < kFew) ticks = EvenTicks(std::pow(10.0, low_), std::pow(10.0, high_));
    return ticks;
  }

  std::vector<double> PowerTicks(const std::vector<double>& factors) const {
    std::vector<double> ticks;
    for (int power = static_cast<int>(std::floor(low_)); power <= std::ceil(high_); ++power) {
      for (const double factor : factors) {
        const double tick = factor * std::pow(10.0, power);
        if (To(tick) >= low_ && To(tick) <= high_) ticks.push_back(tick);
      }
    }
    return ticks;
  }

  static std::vector<double> EvenTicks(double low, double high) {
    const double raw = (high - low) / 6, power = std::pow(10.0, std::floor(std::log10(raw)));
    double step = 10 * power;
    for (const double factor : {1.0, 2.0, 5.0}) {
      if (factor * power >= raw) {
        step = factor * power;
        break;
      }
    }
    std::vector<double> ticks;
    for (double k = std::ceil(low / step); k * step <= high; k += 1) ticks.push_back(k * step);
    return ticks;
  }

  bool log_;
  double low_ = 0, high_ = 1;
};

Axis XAxis(const Plot& plot) {
  if (!plot.categories.empty())
    return Axis(false, 0, static_cast<double>(plot.categories.size()) - 1);
  double low = HUGE_VAL, high = -HUGE_VAL;
  for (const PlotPanel& panel : plot.panels) {
    for (const PlotSeries& series : panel.series) {
      for (const auto& [x, y] : series.points) low = std::min(low, x), high = std::max(high, x);
    }
  }
  return Axis(plot.log_x, low, high);
}

Axis YAxis(const Plot& plot, const PlotPanel& panel) {
  double low = HUGE_VAL, high = -HUGE_VAL;
  for (const PlotSeries& series : panel.series) {
    for (const auto& [x, y] : series.points) {
      if (!std::isfinite(y) || (plot.log_y && !(y > 0))) continue;
      low = std::min(low, y), high = std::max(high, y);
    }
  }
  if (!plot.log_y) low = std::min(low, 0.0);
  return Axis(plot.log_y, low, high);
}

// All x values that occur, so that counts are their own ticks.
std::vector<double> XValues(const Plot& plot) {
  std::vector<double> values;
  for (const PlotPanel& panel : plot.panels) {
    for (const PlotSeries& series : panel.series) {
      for (const auto& point : series.points) values.push_back(point.first);
    }
  }
  std::sort(values.begin(), values.end());
  values.erase(std::unique(values.begin(), values.end()), values.end());
  return values;
}

class PanelDrawing {
 public:
  PanelDrawing(const Plot& plot, const PlotPanel& panel, double left)
      : plot_(plot), panel_(panel), left_(left), x_(XAxis(plot)), y_(YAxis(plot, panel)) {}

  std::string Svg() const {
    std::string svg = Frame();
    for (size_t i = 0; i < panel_.series.size(); ++i) svg += Series(i);
    return svg;
  }

 private:
  double X(double x) const { return left_ + kPanelWidth * x_.At(x); }
  double Y(double y) const { return kTop + kPanelHeight * (1 - y_.At(y)); }

  std::string Frame() const {
    const double bottom = kTop + kPanelHeight;
    std::string svg = Text(left_ + kPanelWidth / 2, kTop - 10, panel_.title, "middle");
    for (const double tick : y_.Ticks()) {
      svg += Line(left_, Y(tick), left_ + kPanelWidth, Y(tick), "#e4e4e4");
      svg += Text(left_ - 6, Y(tick) + 4, fmt::format("{:g}", tick), "end");
    }
    if (plot_.categories.empty()) {
      const auto values = XValues(plot_);
      for (const double tick : values.size() <= 12 ? values : x_.Ticks()) {
        if (!x_.Shows(tick)) continue;
        svg += Line(X(tick), bottom, X(tick), bottom + 4, "#444444");
        svg += Text(X(tick), bottom + 18, fmt::format("{:g}", tick), "middle");
      }
    }
    for (size_t i = 0; i < plot_.categories.size(); ++i) {
      const double x = X(static_cast<double>(i));
      svg += Line(x, bottom, x, bottom + 4, "#444444");
      svg += Text(x, bottom + 14, plot_.categories[i], "end",
                  fmt::format(" transform=\"rotate(-30 {:.1f} {:.1f})\"", x, bottom + 14));
    }
    svg += Text(left_ + kPanelWidth / 2, bottom + Below(plot_) - 14, plot_.x_label, "middle");
    svg += fmt::format(
        "<rect x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.1f}\" height=\"{:.1f}\" fill=\"none\" "
        "stroke=\"#444444\"/>\n",
        left_, kTop, kPanelWidth, kPanelHeight);
    return svg;
  }

  std::string Series(size_t index) const {
    const PlotSeries& series = panel_.series[index];
    const std::string color = Color(panel_.series, index);
    std::string path, marks;
    for (const auto& [x, y] : series.points) {
      if (!x_.Shows(x) || !y_.Shows(y)) continue;
      path += fmt::format("{}{:.1f} {:.1f}", path.empty() ? "M" : " L", X(x), Y(y));
      marks += fmt::format("<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"3\" fill=\"{}\"/>\n", X(x),
                           Y(y), color);
    }
    if (path.empty()) return "";
    return fmt::format("<path d=\"{}\" fill=\"none\" stroke=\"{}\" stroke-width=\"2\"{}/>\n", path,
                       color, Dashes(panel_.series, index)) +
           marks;
  }

  const Plot& plot_;
  const PlotPanel& panel_;
  double left_;
  Axis x_, y_;
};

std::string Legend(const std::vector<PlotSeries>& series, double width, double top) {
  std::string svg;
  const double column = (width - kLeft) / static_cast<double>(kLegendColumns);
  for (size_t i = 0; i < series.size(); ++i) {
    const double x = kLeft + column * static_cast<double>(i % kLegendColumns);
    const double y = top + kLegendLine * static_cast<double>(i / kLegendColumns);
    svg += fmt::format(
        "<line x1=\"{:.1f}\" y1=\"{:.1f}\" x2=\"{:.1f}\" y2=\"{:.1f}\" stroke=\"{}\" "
        "stroke-width=\"2\"{}/>\n",
        x, y - 4, x + 24, y - 4, Color(series, i), Dashes(series, i));
    svg += Text(x + 30, y, series[i].name, "start");
  }
  return svg;
}

}  // namespace

std::string PlotSvg(const Plot& plot) {
  const double panels = static_cast<double>(plot.panels.size());
  const double width = std::max(1.0, panels) * (kLeft + kPanelWidth + kRight);
  const auto series = plot.panels.empty() ? std::vector<PlotSeries>{} : plot.panels[0].series;
  const double lines = static_cast<double>((series.size() + kLegendColumns - 1) / kLegendColumns);
  const double below = kTop + kPanelHeight + Below(plot);
  const double height = below + kLegendLine * lines + 8;
  std::string svg = fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{0:.0f}\" height=\"{1:.0f}\" "
      "viewBox=\"0 0 {0:.0f} {1:.0f}\" font-family=\"sans-serif\" font-size=\"12\">\n"
      "<rect width=\"100%\" height=\"100%\" fill=\"#ffffff\"/>\n",
      width, height);
  svg += Text(width / 2, 22, plot.title, "middle", " font-size=\"15\"");
  for (size_t i = 0; i < plot.panels.size(); ++i) {
    const double left = kLeft + static_cast<double>(i) * (kLeft + kPanelWidth + kRight);
    svg += PanelDrawing(plot, plot.panels[i], left).Svg();
  }
  return svg + Legend(series, width, below + 6) + "</svg>\n";
}

}  // namespace glint
