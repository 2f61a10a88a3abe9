// What a capture's chart told, for the manifest and for people.
#pragma once

#include <string>
#include <vector>

#include "base/files/json.h"
#include "calib/chart/chart.h"
#include "calib/chart/find_chart.h"
#include "calib/chart/measure_chart.h"
#include "calib/chart/solve_chart.h"

namespace glint {

struct ChartResult {
  std::string photo;  // relative to the capture's folder
  Chart chart;
  ChartCorners corners_px;
  bool found = false;  // by its pattern; false: corners_px are capture.toml's
  std::vector<PatchReading> readings;
  ChartSolution solution;
  std::string white_from = "chart";   // or "paper", see capture_chart.h
  std::vector<std::string> findings;  // what a person should know

  bool grey() const { return chart.kind == kGreyCard; }
};

// metrics.chart of calib; docs/manifest.md.
Json ToJson(const ChartResult& result);
// A line, and one for each finding.
std::string TextOf(const ChartResult& result);

// "A1, A2, A3 and 4 more": patches that are not usable.
std::string NamesOfLeftOut(const Chart& chart, const std::vector<PatchReading>& readings);

}  // namespace glint
