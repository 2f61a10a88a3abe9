// Line charts as inline SVG.
#pragma once

#include <string>
#include <vector>

namespace glint {

struct ChartLine {
  std::string name;
  std::vector<double> x, y;  // of one length; points that are not finite are left out
};

struct Chart {
  std::string title;
  std::string x_label;
  std::vector<ChartLine> lines;
  // Vertical axis logarithmic; taken only where all values are positive and span a factor of 5.
  bool may_be_logarithmic = true;
};

// Empty when no line has two points.
std::string ChartSvg(const Chart& chart);

}  // namespace glint
