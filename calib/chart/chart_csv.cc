#include <algorithm>
#include <charconv>
#include <cmath>
#include <map>
#include <sstream>

#include "base/errors/errors.h"
#include "base/files/files.h"
#include "base/files/json.h"
#include "calib/chart/chart.h"
#include "calib/chart/cielab.h"

namespace glint {
namespace {

constexpr const char* kRemedy =
    "write a line \"name,x,y,L,a,b\" (or X,Y,Z), then one for each patch: x and y from 0 to 1 from "
    "the top left corner";
constexpr std::size_t kMostPatches = 2000;

std::vector<std::string> CellsOf(const std::string& line) {
  std::vector<std::string> cells;
  std::stringstream stream(line);
  for (std::string cell; std::getline(stream, cell, ',');) {
    const auto first = cell.find_first_not_of(" \t\r\""), last = cell.find_last_not_of(" \t\r\"");
    cells.push_back(first == std::string::npos ? "" : cell.substr(first, last - first + 1));
  }
  return cells;
}

// Manifests hold the patches' names, and JSON is UTF-8.
std::string TextOfTable(const std::filesystem::path& file) {
  std::string text = ReadTextFile(file, 1u << 20);
  constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";  // spreadsheets write it
  if (text.starts_with(kByteOrderMark)) text.erase(0, kByteOrderMark.size());
  try {
    (void)Json(text).dump();
  } catch (const nlohmann::json::exception&) {
    throw UserError(file, "", "bytes that are not UTF-8", "save the table as UTF-8");
  }
  if (text.empty()) throw UserError(file, "", "no table", kRemedy);
  return text;
}

// The table's columns by name, and where to complain.
class ChartTable {
 public:
  ChartTable(const std::filesystem::path& file, const std::string& header) : file_(file) {
    const auto names = CellsOf(header);
    for (std::size_t i = 0; i < names.size(); ++i) columns_[names[i]] = i;
    for (const char* name : {"name", "x", "y"}) Require(name);
    lab_ = columns_.count("L") > 0;
    for (const char* name : lab_ ? std::array{"L", "a", "b"} : std::array{"X", "Y", "Z"}) {
      Require(name);
    }
  }

  bool lab() const { return lab_; }

  double Number(const std::vector<std::string>& cells, const std::string& name, int line,
                double least, double most) const {
    const std::string text = Text(cells, name);
    double value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error == std::errc() && end == text.data() + text.size() && value >= least && value <= most)
      return value;
    std::ostringstream remedy;
    remedy << "give a number from " << least << " to " << most;
    throw UserError(file_, "line " + std::to_string(line) + ", " + name, "'" + text + "'",
                    remedy.str());
  }
  std::string Text(const std::vector<std::string>& cells, const std::string& name) const {
    const std::size_t at = columns_.at(name);
    return at < cells.size() ? cells[at] : "";
  }

 private:
  void Require(const std::string& name) const {
    if (columns_.count(name) == 0) {
      throw UserError(file_, "line 1", "no column '" + name + "'", kRemedy);
    }
  }

  std::filesystem::path file_;
  std::map<std::string, std::size_t> columns_;
  bool lab_ = false;
};

// XYZ as it stands in the table, Y of white being 100, or Lab.
Eigen::Vector3d StatedColour(const ChartTable& table, const std::vector<std::string>& cells,
                             int line) {
  if (table.lab()) {
    return {table.Number(cells, "L", line, 0, 150), table.Number(cells, "a", line, -200, 200),
            table.Number(cells, "b", line, -200, 200)};
  }
  return {table.Number(cells, "X", line, 0, 200), table.Number(cells, "Y", line, 0, 200),
          table.Number(cells, "Z", line, 0, 200)};
}

Eigen::Vector3d LabUnderD50(const Eigen::Vector3d& stated, bool is_lab,
                            const Eigen::Vector3d& from_white) {
  const Eigen::Vector3d to_white = *WhitePoint(kLabIlluminant);
  if (is_lab && from_white == to_white) return stated;
  const Eigen::Vector3d xyz = is_lab ? XyzFromLab(stated, from_white) : stated / 100;
  return LabFromXyz(AdaptedXyz(xyz, from_white, to_white), to_white);
}

void SetHalfSides(std::vector<ChartPatch>* patches) {
  for (ChartPatch& patch : *patches) {
    double nearest = 1;  // of a single patch, the chart
    for (const ChartPatch& other : *patches) {
      const double distance = (patch.centre - other.centre).lpNorm<Eigen::Infinity>();
      if (&other != &patch) nearest = std::min(nearest, distance);
    }
    patch.half_side = nearest / 2;
  }
}

}  // namespace

Chart ReadChartCsv(const std::filesystem::path& file, std::string_view illuminant, double aspect) {
  std::istringstream stream(TextOfTable(file));
  std::string line;
  std::getline(stream, line);
  const ChartTable table(file, line);
  const Eigen::Vector3d white = WhitePoint(illuminant).value();
  Chart chart{file.filename(), {aspect, 1}, {}};
  double brightest = 0;
  for (int number = 2; std::getline(stream, line); ++number) {
    const auto cells = CellsOf(line);
    if (cells.empty() || (cells.size() == 1 && cells[0].empty())) continue;
    const Eigen::Vector3d stated = StatedColour(table, cells, number);
    brightest = std::max(brightest, stated[table.lab() ? 0 : 1]);
    chart.patches.push_back(
        {table.Text(cells, "name"),
         {aspect * table.Number(cells, "x", number, 0, 1), table.Number(cells, "y", number, 0, 1)},
         0,
         LabUnderD50(stated, table.lab(), white)});
    if (chart.patches.size() > kMostPatches) {
      throw UserError(file, "", "more than " + std::to_string(kMostPatches) + " patches", kRemedy);
    }
  }
  constexpr double kDarkest = 2;  // a chart without a patch above 2 % is one whose white is 1
  if (brightest <= kDarkest) {
    throw UserError(file, table.lab() ? "L" : "Y", "no value above 2",
                    "give colours in which a perfect white has L = 100, Y = 100");
  }
  SetHalfSides(&chart.patches);
  for (const ChartPatch& patch : chart.patches) {
    if (patch.half_side > 0) continue;
    throw UserError(file, patch.name, "two patches at the same position", "correct x and y");
  }
  return chart;
}

}  // namespace glint
