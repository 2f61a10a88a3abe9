#include "datasets/evaluation/experiment_result.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

namespace glint {
namespace {

constexpr std::array<const char*, 6> kColumns{"diffuse", "specular",    "roughness",
                                              "normal",  "map_average", "render"};

std::array<double, 6> Figures(const Table1Row& row) {
  return {row.maps.diffuse, row.maps.specular,  row.maps.roughness,
          row.maps.normal,  row.maps.average(), row.render};
}

void Accumulate(const Table1Row& row, double weight, Table1Row* sum) {
  sum->maps.diffuse += weight * row.maps.diffuse;
  sum->maps.specular += weight * row.maps.specular;
  sum->maps.roughness += weight * row.maps.roughness;
  sum->maps.normal += weight * row.maps.normal;
  sum->render += weight * row.render;
}

bool SameCell(const ExperimentEntry& a, const ExperimentEntry& b) {
  return a.count == b.count && a.condition == b.condition && a.method == b.method;
}

// Which of the optional columns there are.
struct Shape {
  explicit Shape(const std::vector<ExperimentEntry>& entries) {
    for (const ExperimentEntry& entry : entries) {
      conditions = conditions || !entry.condition.empty();
      saturated = saturated || entry.saturated >= 0;
      lights = lights || entry.light_mean_deg >= 0;
    }
  }
  bool conditions = false, saturated = false, lights = false;
};

// Letters, not bytes: conditions have degree signs.
size_t Width(const std::string& text) {
  return static_cast<size_t>(
      std::count_if(text.begin(), text.end(), [](char c) { return (c & 0xc0) != 0x80; }));
}

std::string Padded(const std::string& text, size_t width) {
  return text + std::string(width - std::min(width, Width(text)), ' ');
}

struct Widths {
  size_t condition = 9, method = 7;
  explicit Widths(const std::vector<ExperimentEntry>& entries) {
    for (const ExperimentEntry& entry : entries) {
      condition = std::max(condition, Width(entry.condition));
      method = std::max(method, Width(entry.method));
    }
  }
};

std::string Heading(const Shape& shape, const Widths& widths, bool paper) {
  const auto rule = [](size_t width) { return std::string(width + 2, '-') + "|"; };
  std::string names = "|  N | ", rules = "|---:|";
  if (shape.conditions) {
    names += Padded("condition", widths.condition) + " | ";
    rules += rule(widths.condition);
  }
  names += Padded("method", widths.method) +
           " |  diffuse | specular | roughness |   normal | map average |   render |";
  rules += rule(widths.method) +
           "---------:|---------:|----------:|---------:|------------:|---------:|";
  if (shape.saturated) {
    names += " saturated |";
    rules += "----------:|";
  }
  if (shape.lights) {
    names += " light off, mean | largest |";
    rules += "----------------:|--------:|";
  }
  if (paper) {
    names += " paper: map | paper: render |";
    rules += "-----------:|--------------:|";
  }
  return names + "\n" + rules + "\n";
}

}  // namespace

Json ErrorsJson(const Table1Row& row) {
  Json json;
  const auto figures = Figures(row);
  for (size_t i = 0; i < figures.size(); ++i) json[kColumns[i]] = figures[i];
  return json;
}

std::vector<ExperimentEntry> ExperimentResult::Means() const {
  std::vector<ExperimentEntry> means;
  std::vector<int> members;
  const auto place = [&](const ExperimentEntry& entry) {
    const auto same = [&](const ExperimentEntry& mean) { return SameCell(mean, entry); };
    return static_cast<size_t>(std::find_if(means.begin(), means.end(), same) - means.begin());
  };
  for (const ExperimentEntry& entry : entries) {
    const size_t at = place(entry);
    if (at == means.size()) {
      means.push_back({"mean", entry.count, entry.condition, entry.method, {}, -1});
      members.push_back(0);
    }
    ++members[at];
  }
  for (const ExperimentEntry& entry : entries) {
    const size_t at = place(entry);
    Accumulate(entry.errors, 1.0 / members[at], &means[at].errors);
    if (entry.saturated >= 0) {
      means[at].saturated = std::max(0.0, means[at].saturated) + entry.saturated / members[at];
    }
    if (entry.light_mean_deg >= 0) {
      means[at].light_mean_deg =
          std::max(0.0, means[at].light_mean_deg) + entry.light_mean_deg / members[at];
      means[at].light_worst_deg = std::max(means[at].light_worst_deg, entry.light_worst_deg);
    }
  }
  std::stable_sort(means.begin(), means.end(),
                   [](const auto& a, const auto& b) { return a.count < b.count; });
  return means;
}

std::optional<ExperimentEntry> ExperimentResult::Mean(int count, const std::string& condition,
                                                      const std::string& method) const {
  for (const ExperimentEntry& mean : Means()) {
    if (mean.count == count && mean.condition == condition && mean.method == method) return mean;
  }
  return std::nullopt;
}

std::string ExperimentResult::Text(const Paper& paper) const {
  const std::vector<ExperimentEntry> means = Means();
  const Shape shape(means);
  const Widths widths(means);
  std::string text = Heading(shape, widths, static_cast<bool>(paper));
  for (const ExperimentEntry& mean : means) {
    const auto f = Figures(mean.errors);
    text += fmt::format("| {:2} | ", mean.count);
    if (shape.conditions) text += Padded(mean.condition, widths.condition) + " | ";
    text += Padded(mean.method, widths.method);
    text += fmt::format(" | {:.6f} | {:.6f} | {:9.6f} | {:.6f} | {:11.6f} | {:.6f} |", f[0], f[1],
                        f[2], f[3], f[4], f[5]);
    if (shape.saturated) text += fmt::format(" {:8.2f}% |", 100 * std::max(0.0, mean.saturated));
    if (shape.lights) {
      text += fmt::format(" {:14.2f}° | {:6.2f}° |", mean.light_mean_deg, mean.light_worst_deg);
    }
    if (paper) {
      const auto theirs = paper(mean);
      text += theirs ? fmt::format(" {:10.5f} | {:13.6f} |", theirs->map_average, theirs->render)
                     : fmt::format(" {:>10} | {:>13} |", "", "");
    }
    text += "\n";
  }
  return text;
}

std::string ExperimentResult::Csv() const {
  const Shape shape(entries);
  std::string text =
      std::string("material,views,") + (shape.conditions ? "condition," : "") + "method";
  for (const char* column : kColumns) text += fmt::format(",{}", column);
  if (shape.saturated) text += ",saturated";
  if (shape.lights) text += ",light_mean_deg,light_worst_deg";
  text += "\n";
  const std::vector<ExperimentEntry> means = Means();
  for (const auto* list : {&entries, &means}) {
    for (const ExperimentEntry& entry : *list) {
      text += fmt::format("{},{},", entry.material, entry.count);
      if (shape.conditions) text += "\"" + entry.condition + "\",";
      text += entry.method;
      for (const double figure : Figures(entry.errors)) text += fmt::format(",{:.8g}", figure);
      if (shape.saturated) text += fmt::format(",{:.6g}", entry.saturated);
      if (shape.lights) {
        text += fmt::format(",{:.6g},{:.6g}", entry.light_mean_deg, entry.light_worst_deg);
      }
      text += "\n";
    }
  }
  return text;
}

Json ExperimentResult::ToJson() const {
  const Shape shape(entries);
  const auto list = [&](const std::vector<ExperimentEntry>& rows) {
    Json json = Json::array();
    for (const ExperimentEntry& entry : rows) {
      Json row = {{"material", entry.material}, {"views", entry.count}};
      if (shape.conditions) row["condition"] = entry.condition;
      row["method"] = entry.method;
      row["errors"] = ErrorsJson(entry.errors);
      if (shape.saturated) row["saturated"] = entry.saturated;
      if (shape.lights) {
        row["light_off_deg"] = {{"mean", entry.light_mean_deg}, {"largest", entry.light_worst_deg}};
      }
      json.push_back(row);
    }
    return json;
  };
  return {{"means", list(Means())}, {"entries", list(entries)}};
}

}  // namespace glint
