#include "training/loss_plot.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <iomanip>
#include <limits>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

namespace glint {
namespace {

constexpr double kWidth = 720, kHeight = 420, kLeft = 62, kRight = 16, kTop = 16, kBottom = 44;

struct Curve {
  const char* column;
  const char* label;
  const char* colour;
  std::vector<std::array<double, 2>> points;  // step, loss
};

std::vector<std::string> Split(const std::string& line) {
  std::vector<std::string> parts;
  std::istringstream in(line);
  for (std::string part; std::getline(in, part, ',');) parts.push_back(part);
  return parts;
}

std::vector<Curve> ReadCurves(const std::filesystem::path& log_csv) {
  std::vector<Curve> curves{{"map", "maps, L1", "#1f6feb", {}},
                            {"smoothness", "smoothness", "#2da44e", {}},
                            {"render", "renderings, log-L1", "#bf8700", {}},
                            {"validation", "validation, maps", "#cf222e", {}}};
  std::ifstream in(log_csv);
  std::string line;
  if (!std::getline(in, line)) {
    throw std::runtime_error(log_csv.string() + ": found no loss log; name OUT.csv of a training");
  }
  const std::vector<std::string> names = Split(line);
  while (std::getline(in, line)) {
    const std::vector<std::string> parts = Split(line);
    for (Curve& curve : curves) {
      const auto at = std::find(names.begin(), names.end(), curve.column) - names.begin();
      if (at >= static_cast<std::ptrdiff_t>(parts.size())) continue;
      const double step = std::strtod(parts[0].c_str(), nullptr);
      const double loss = std::strtod(parts[static_cast<size_t>(at)].c_str(), nullptr);
      if (step > 0 && loss > 0) curve.points.push_back({step, loss});
    }
  }
  return curves;
}

// A logarithmic axis from `low` to `high`, drawn from `from` to `to`.
struct Axis {
  double low, high, from, to;
  double At(double value) const {
    return from + (to - from) * std::log(value / low) / std::log(high / low);
  }
  // 1, 2 and 5 times powers of ten.
  std::vector<double> Ticks() const {
    std::vector<double> ticks;
    for (double power = std::pow(10.0, std::floor(std::log10(low))); power <= high; power *= 10) {
      for (const double factor : {1.0, 2.0, 5.0}) {
        const double tick = factor * power;
        if (tick >= low && tick <= high) ticks.push_back(tick);
      }
    }
    return ticks;
  }
};

Axis AxisOf(const std::vector<Curve>& curves, int coordinate, double from, double to) {
  double low = std::numeric_limits<double>::infinity(), high = 0;
  for (const Curve& curve : curves) {
    for (const auto& point : curve.points) {
      low = std::min(low, point[static_cast<size_t>(coordinate)]);
      high = std::max(high, point[static_cast<size_t>(coordinate)]);
    }
  }
  if (!(high > 0)) return {1, 10, from, to};
  if (!(high > 1.05 * low)) return {0.9 * low, 1.1 * high, from, to};
  return {low, high, from, to};
}

void DrawGrid(const Axis& x, const Axis& y, std::ostream& out) {
  for (const double tick : x.Ticks()) {
    out << "<path d='M" << x.At(tick) << ' ' << kTop << "V" << kHeight - kBottom
        << "' stroke='#ddd'/><text x='" << x.At(tick) << "' y='" << kHeight - kBottom + 18
        << "' text-anchor='middle'>" << tick << "</text>\n";
  }
  for (const double tick : y.Ticks()) {
    out << "<path d='M" << kLeft << ' ' << y.At(tick) << "H" << kWidth - kRight
        << "' stroke='#ddd'/><text x='" << kLeft - 6 << "' y='" << y.At(tick) + 4
        << "' text-anchor='end'>" << tick << "</text>\n";
  }
  out << "<text x='" << (kLeft + kWidth - kRight) / 2 << "' y='" << kHeight - 8
      << "' text-anchor='middle'>steps</text>\n";
}

}  // namespace

void WriteLossPlot(const std::filesystem::path& log_csv, const std::filesystem::path& svg) {
  const std::vector<Curve> curves = ReadCurves(log_csv);
  const Axis x = AxisOf(curves, 0, kLeft, kWidth - kRight);
  const Axis y = AxisOf(curves, 1, kHeight - kBottom, kTop);
  std::ostringstream out;
  out << std::setprecision(6) << "<svg xmlns='http://www.w3.org/2000/svg' width='" << kWidth
      << "' height='" << kHeight << "' font-family='sans-serif' font-size='12'>\n"
      << "<rect width='100%' height='100%' fill='white'/>\n";
  DrawGrid(x, y, out);
  double label_y = kTop + 16;
  for (const Curve& curve : curves) {
    if (curve.points.empty()) continue;
    out << "<polyline fill='none' stroke='" << curve.colour << "' stroke-width='1.5' points='";
    for (const auto& point : curve.points) out << x.At(point[0]) << ',' << y.At(point[1]) << ' ';
    out << "'/><text x='" << kWidth - kRight - 150 << "' y='" << label_y << "' fill='"
        << curve.colour << "'>" << curve.label << "</text>\n";
    label_y += 16;
  }
  out << "</svg>\n";
  std::ofstream file(svg, std::ios::binary | std::ios::trunc);
  if (!(file << out.str())) {
    throw std::runtime_error(svg.string() + ": cannot be written; check the folder and the disk");
  }
}

}  // namespace glint
