// A line plot as SVG: panels side by side with axes, ticks, a legend and logarithmic scales.
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace glint {

struct PlotSeries {
  std::string name;
  std::vector<std::pair<double, double>> points;  // (x, y), by x
  int dashed_like = -1;  // drawn dashed in the colour of the series with this index; −1: a line
};

struct PlotPanel {
  std::string title;
  std::vector<PlotSeries> series;
};

// Panels share the x axis' meaning and the series' names and colours.
struct Plot {
  std::string title, x_label;
  bool log_x = false, log_y = false;
  // Given: x counts these, from 0, and ticks are they.
  std::vector<std::string> categories;
  std::vector<PlotPanel> panels;
};

// Points that are not finite, or not above 0 on a logarithmic axis, are left out. The same plot
// gives the same bytes.
std::string PlotSvg(const Plot& plot);

}  // namespace glint
