// Errors by material, condition and method: an experiment's outcome as tables.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "base/files/json.h"
#include "datasets/evaluation/map_error.h"

namespace glint {

struct ExperimentEntry {
  std::string material;
  int count = 0;          // views
  std::string condition;  // empty where the number of views says all
  std::string method;
  Table1Row errors;
  double saturated = -1;  // share of saturated texels; below 0: not measured
  // Angle between the lights that were used and the true ones: mean and largest over the views (and
  // in a mean over the materials); below 0: not measured.
  double light_mean_deg = -1, light_worst_deg = -1;
};

// What the paper prints for a like entry.
struct PaperFigures {
  double map_average = 0, render = 0;
};

Json ErrorsJson(const Table1Row& row);

struct ExperimentResult {
  std::string name;
  std::vector<ExperimentEntry> entries;

  // One entry for each count, condition and method, averaged over materials (material: "mean"), by
  // count, then in order of appearance.
  std::vector<ExperimentEntry> Means() const;
  // The mean of that count, condition and method.
  std::optional<ExperimentEntry> Mean(int count, const std::string& condition,
                                      const std::string& method) const;
  // The means as Markdown. `paper` gives the paper's figures for an entry, where it has any; they
  // stand in two more columns.
  using Paper = std::function<std::optional<PaperFigures>(const ExperimentEntry&)>;
  std::string Text(const Paper& paper = {}) const;
  std::string Csv() const;  // all entries and the means
  Json ToJson() const;
};

}  // namespace glint
