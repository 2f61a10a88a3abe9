#include <algorithm>

#include "base/files/files.h"
#include "datasets/evaluation/paper_experiments.h"
#include "datasets/evaluation/picture_sheet.h"

namespace glint {
namespace {

struct Place {
  std::string series;
  double x = 0;
};

// Where a mean belongs in a plot.
class Layout {
 public:
  explicit Layout(const std::vector<ExperimentEntry>& means) {
    for (const ExperimentEntry& mean : means) {
      Append(mean.condition, &conditions_);
      Append(std::to_string(mean.count), &counts_);
      Append(mean.method, &methods_);
    }
  }
  // What the x axis counts; empty: it is the number of views.
  const std::vector<std::string>& categories() const {
    static const std::vector<std::string> none;
    if (counts_.size() > 1) return none;
    return conditions_.size() > 1 ? conditions_ : methods_;
  }

  Place Of(const ExperimentEntry& mean) const {
    const std::string condition = mean.condition.empty() ? "" : ", " + mean.condition;
    if (counts_.size() > 1) return {mean.method + condition, static_cast<double>(mean.count)};
    if (conditions_.size() > 1) return {mean.method, Index(mean.condition, conditions_)};
    return {"N = " + std::to_string(mean.count) + condition, Index(mean.method, methods_)};
  }

 private:
  static void Append(const std::string& text, std::vector<std::string>* list) {
    if (std::find(list->begin(), list->end(), text) == list->end()) list->push_back(text);
  }
  static double Index(const std::string& text, const std::vector<std::string>& list) {
    return static_cast<double>(std::find(list.begin(), list.end(), text) - list.begin());
  }
  std::vector<std::string> conditions_, counts_, methods_;
};

// Appends to the series `name`; a new one is dashed like the series `like`, if that is given.
void AddPoint(const std::string& name, const std::string& like, double x, double y,
              PlotPanel* panel) {
  const auto index = [&](const std::string& wanted) {
    const auto found =
        std::find_if(panel->series.begin(), panel->series.end(),
                     [&](const PlotSeries& series) { return series.name == wanted; });
    return found - panel->series.begin();
  };
  if (index(name) == std::ssize(panel->series)) {
    panel->series.push_back({name, {}, like.empty() ? -1 : static_cast<int>(index(like))});
  }
  panel->series[static_cast<size_t>(index(name))].points.emplace_back(x, y);
}

void AddPoints(const std::string& name, const std::string& like, double x,
               const PaperFigures& errors, Plot* plot) {
  AddPoint(name, like, x, errors.map_average, &plot->panels[0]);
  AddPoint(name, like, x, errors.render, &plot->panels[1]);
}

}  // namespace

Plot PlotOf(const ExperimentResult& result, const ExperimentResult::Paper& paper) {
  const std::vector<ExperimentEntry> means = result.Means();
  const Layout layout(means);
  Plot plot;
  plot.title = result.name;
  plot.log_y = true;
  plot.categories = layout.categories();
  if (plot.categories.empty()) {
    plot.log_x = true;
    plot.x_label = "number of views";
  }
  plot.panels = {{"map average (mean squared error)", {}}, {"render (mean squared error)", {}}};
  for (const ExperimentEntry& mean : means) {
    const Place place = layout.Of(mean);
    AddPoints(place.series, "", place.x, {mean.errors.maps.average(), mean.errors.render}, &plot);
  }
  if (!paper) return plot;
  for (const ExperimentEntry& mean : means) {
    const Place place = layout.Of(mean);
    const auto theirs = paper(mean);
    if (theirs) AddPoints("paper: " + place.series, place.series, place.x, *theirs, &plot);
  }
  return plot;
}

void WriteExperiment(const Experiment& experiment, const ExperimentResult& result,
                     const ExperimentResult::Paper& paper, const Json& json, int threads) {
  const auto file = [&](const char* extension) {
    return experiment.work / (experiment.name + extension);
  };
  WriteFileAtomically(file(".csv"), result.Csv());
  WriteFileAtomically(file(".json"), json.dump(2) + "\n");
  WriteFileAtomically(file(".svg"), PlotSvg(PlotOf(result, paper)));
  WritePng(file(".png"), DrawSheet(experiment, threads));
}

}  // namespace glint
