#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "datasets/evaluation/held_out_views.h"
#include "datasets/looks/looks_figures.h"

namespace glint {
namespace {

void Append(const std::string& text, std::vector<std::string>* list) {
  if (std::find(list->begin(), list->end(), text) == list->end()) list->push_back(text);
}

std::vector<std::string> Methods(const std::vector<HoldoutEntry>& entries) {
  std::vector<std::string> methods;
  for (const HoldoutEntry& entry : entries) Append(entry.method, &methods);
  return methods;
}

const HoldoutEntry* Find(const std::vector<HoldoutEntry>& entries, const std::string& set,
                         const std::string& split, const std::string& method) {
  for (const HoldoutEntry& entry : entries) {
    if (entry.set == set && entry.split == split && entry.method == method) return &entry;
  }
  return nullptr;
}

void Accumulate(const HoldoutFigures& figures, double weight, HoldoutFigures* sum) {
  sum->log_l1 += weight * figures.log_l1;
  sum->mse += weight * figures.mse;
  if (figures.standardised >= 0) {
    sum->standardised = std::max(0.0, sum->standardised) + weight * figures.standardised;
  }
}

std::string Line(const std::vector<HoldoutEntry>& entries, const std::vector<std::string>& methods,
                 const std::string& set, const std::string& split) {
  std::string text = fmt::format("| {:<26} | {:<16} |", set, split);
  const HoldoutEntry* last = nullptr;
  for (const std::string& method : methods) {
    const HoldoutEntry* entry = Find(entries, set, split, method);
    text += entry ? fmt::format(" {:>{}.4f} |", entry->held_out.log_l1,
                                std::max<size_t>(6, method.size()))
                  : fmt::format(" {:>{}} |", "", std::max<size_t>(6, method.size()));
    if (entry) last = entry;
  }
  if (last == nullptr) return "";
  text += fmt::format(" {:>12.4f} |", last->fitted.log_l1);
  text += last->held_out.standardised >= 0
              ? fmt::format(" {:>12.2f} |\n", last->held_out.standardised)
              : fmt::format(" {:>12} |\n", "");
  return text;
}

constexpr int kLooksNameWidth = 34;

std::string LooksHead(const std::string& method) {
  std::string text = fmt::format("| {:<{}} | {:<16} |", "looks of held-out views, " + method,
                                 kLooksNameWidth, "split");
  std::string rule = "|" + std::string(kLooksNameWidth + 2, '-') + "|" + std::string(18, '-') + "|";
  for (const LooksColumn& column : LooksColumns(kFineBands)) {
    const std::string heading = column.heading();
    const int width = LooksWidth(heading);
    text += fmt::format(" {:>{}} |", heading, width);
    rule += std::string(static_cast<size_t>(width) + 1, '-') + ":|";
  }
  return text + "\n" + rule + "\n";
}

std::string LooksLine(const std::string& set, const std::string& split, const Looks& looks) {
  std::string text = fmt::format("| {:<{}} | {:<16} |", set, kLooksNameWidth, split);
  for (const LooksColumn& column : LooksColumns(kFineBands)) {
    text += fmt::format(" {:>{}} |", LooksText(column.ValueOf(looks), column.figure->decimals),
                        LooksWidth(column.heading()));
  }
  return text + "\n";
}

// Of the method that was run last.
std::string LooksTable(const std::vector<HoldoutEntry>& entries,
                       const std::vector<HoldoutEntry>& means) {
  if (entries.empty()) return "";
  const std::string& method = entries.back().method;
  std::string text = LooksHead(method);
  for (const HoldoutEntry& mean : means) {
    if (mean.method != method) continue;
    for (const HoldoutEntry& entry : entries) {
      if (entry.method != method || entry.split != mean.split) continue;
      text += LooksLine(entry.set, entry.split, entry.held_out.looks);
    }
    text += LooksLine("mean", mean.split, mean.held_out.looks);
    text += LooksLine("mean of fitted views", mean.split, mean.fitted.looks);
  }
  return text;
}

// Empty where it is unknown.
std::string CsvFigure(double figure) {
  return std::isnan(figure) ? "" : fmt::format("{:.6g}", figure);
}

Json FiguresJson(const HoldoutFigures& figures) {
  Json json = {{"log_l1", figures.log_l1}, {"mse", figures.mse}};
  json.update(ToJson(figures.looks));
  return json;
}

}  // namespace

std::vector<HoldoutEntry> HoldoutResult::Means() const {
  std::vector<HoldoutEntry> means;
  std::vector<double> members;
  std::vector<std::vector<Looks>> fitted, held_out;
  const auto place = [&](const HoldoutEntry& entry) {
    const auto same = [&](const HoldoutEntry& mean) {
      return mean.split == entry.split && mean.method == entry.method;
    };
    return static_cast<size_t>(std::find_if(means.begin(), means.end(), same) - means.begin());
  };
  for (const HoldoutEntry& entry : entries) {
    const size_t at = place(entry);
    if (at == means.size()) {
      HoldoutEntry mean = entry;
      mean.set = "mean";
      mean.fitted = mean.held_out = {};
      mean.manifest.clear();
      mean.views.clear();
      means.push_back(mean);
      members.push_back(0);
      fitted.emplace_back();
      held_out.emplace_back();
    }
    members[at] += 1;
    fitted[at].push_back(entry.fitted.looks);
    held_out[at].push_back(entry.held_out.looks);
  }
  for (const HoldoutEntry& entry : entries) {
    const size_t at = place(entry);
    Accumulate(entry.fitted, 1 / members[at], &means[at].fitted);
    Accumulate(entry.held_out, 1 / members[at], &means[at].held_out);
  }
  for (size_t at = 0; at < means.size(); ++at) {
    means[at].fitted.looks = MeanLooks(fitted[at]);
    means[at].held_out.looks = MeanLooks(held_out[at]);
  }
  return means;
}

std::string HoldoutResult::Markdown() const {
  const std::vector<std::string> methods = Methods(entries);
  std::string text = fmt::format("| {:<26} | {:<16} |", "log-L1 of held-out views", "split");
  std::string rule = "|" + std::string(28, '-') + "|" + std::string(18, '-') + "|";
  for (const std::string& method : methods) {
    text += fmt::format(" {:>6} |", method);
    rule += std::string(std::max<size_t>(6, method.size()) + 1, '-') + ":|";
  }
  text += " fitted views | standardised |\n" + rule + "-------------:|-------------:|\n";
  std::vector<std::string> sets, splits;
  for (const HoldoutEntry& entry : entries) {
    Append(entry.set, &sets);
    Append(entry.split, &splits);
  }
  const std::vector<HoldoutEntry> means = Means();
  for (const std::string& split : splits) {
    for (const std::string& set : sets) text += Line(entries, methods, set, split);
    text += Line(means, methods, "mean", split);
  }
  return text + "\n" + LooksTable(entries, means);
}

std::string HoldoutResult::Csv() const {
  std::string text =
      "set,split,method,fitted_views,held_out_views,fitted_log_l1,held_out_log_l1,fitted_mse,"
      "held_out_mse,standardised_rms";
  const std::vector<LooksColumn> columns = LooksColumns();
  for (const LooksColumn& column : columns) {
    text += fmt::format(",fitted_{0},held_out_{0}", column.key());
  }
  text += "\n";
  const std::vector<HoldoutEntry> means = Means();
  for (const auto* list : {&entries, &means}) {
    for (const HoldoutEntry& e : *list) {
      text += fmt::format("{},\"{}\",{},{},{},{:.6g},{:.6g},{:.6g},{:.6g},", e.set, e.split,
                          e.method, e.fitted_views, e.held_out_views, e.fitted.log_l1,
                          e.held_out.log_l1, e.fitted.mse, e.held_out.mse);
      if (e.held_out.standardised >= 0) text += fmt::format("{:.4g}", e.held_out.standardised);
      for (const LooksColumn& column : columns) {
        text += "," + CsvFigure(column.ValueOf(e.fitted.looks)) + "," +
                CsvFigure(column.ValueOf(e.held_out.looks));
      }
      text += "\n";
    }
  }
  return text;
}

Json HoldoutResult::ToJson() const {
  const auto list = [](const std::vector<HoldoutEntry>& rows) {
    Json json = Json::array();
    for (const HoldoutEntry& e : rows) {
      Json row = {{"set", e.set},
                  {"split", e.split},
                  {"method", e.method},
                  {"fitted_views", e.fitted_views},
                  {"held_out_views", e.held_out_views},
                  {"fitted", FiguresJson(e.fitted)},
                  {"held_out", FiguresJson(e.held_out)}};
      if (e.held_out.standardised >= 0) row["standardised_rms"] = e.held_out.standardised;
      json.push_back(row);
    }
    return json;
  };
  return {{"means", list(Means())}, {"entries", list(entries)}};
}

}  // namespace glint
