#include "datasets/evaluation/paper_experiments.h"

#include <fmt/format.h>

#include <algorithm>

#include "base/errors/errors.h"
#include "datasets/evaluation/named_weights.h"
#include "datasets/evaluation/paper_figures.h"
#include "datasets/evaluation/starts.h"

namespace glint {
namespace {

Condition Plain(const PaperExperimentOptions& options, int count) {
  Condition condition;
  condition.folder = fmt::format("n{:02}", count);
  condition.views = options.views;
  condition.views.count = count;
  condition.views.disturbance = {};
  return condition;
}

Condition Named(Condition condition, const std::string& folder, const std::string& name) {
  if (!folder.empty()) condition.folder += "_" + folder;
  condition.name = name;
  return condition;
}

// Without conditions; their common parts.
Experiment Base(const std::string& name, const PaperExperimentOptions& options) {
  Experiment experiment;
  experiment.name = name;
  experiment.materials = options.materials;
  experiment.work = options.work;
  experiment.size = options.size;
  for (const std::string& method : options.methods) {
    experiment.methods.push_back(
        NamedMethod(method, options.fit_arguments, options.refine_arguments));
  }
  return experiment;
}

Experiment ByCount(const std::string& name, const PaperExperimentOptions& options) {
  Experiment experiment = Base(name, options);
  for (const int count : options.counts) experiment.conditions.push_back(Plain(options, count));
  return experiment;
}

Experiment Table1(const PaperExperimentOptions& options) {
  if (!options.disturb) return ByCount("table1", options);
  Experiment experiment = Base("table1", options);
  for (const char* name : {"", kDisturbed}) {
    for (const int count : options.counts) {
      Condition condition = Named(Plain(options, count), name, name);
      if (*name != 0) {
        condition.views.disturbance = EverydayDisturbance();
        condition.views.disturbance.environment = options.views.disturbance.environment;
      }
      experiment.conditions.push_back(condition);
    }
  }
  return experiment;
}

constexpr double kStrengths[] = {1, 5, 10};  // degrees of light, percent of environment

std::string LightName(double degrees) { return fmt::format("light off by {:g}°", degrees); }
std::string EnvironmentName(double percent) { return fmt::format("environment {:g} %", percent); }
constexpr char kUndisturbed[] = "undisturbed";

Experiment Table2(const PaperExperimentOptions& options) {
  Experiment experiment = Base("table2", options);
  for (const int count : options.counts) {
    const Condition plain = Plain(options, count);
    experiment.conditions.push_back(Named(plain, "", kUndisturbed));
    for (const double strength : kStrengths) {
      Condition light = Named(plain, fmt::format("light{:02g}", strength), LightName(strength));
      light.views.disturbance.light_off_deg = strength;
      experiment.conditions.push_back(light);
    }
    for (const double strength : kStrengths) {
      Condition environment =
          Named(plain, fmt::format("environment{:02g}", strength), EnvironmentName(strength));
      environment.views.disturbance.environment_percent = strength;
      environment.views.disturbance.environment = options.views.disturbance.environment;
      experiment.conditions.push_back(environment);
    }
  }
  return experiment;
}

// Lights off by 10°, each in a direction of its own or all together.
Experiment Lights(const PaperExperimentOptions& options) {
  constexpr double kOff_deg = 10;
  Experiment experiment = Base("lights", options);
  experiment.compare_lights = true;
  for (const int count : options.counts) {
    const Condition plain = Plain(options, count);
    experiment.conditions.push_back(Named(plain, "", kUndisturbed));
    for (const bool together : {false, true}) {
      Condition off = Named(plain, together ? "together10" : "light10",
                            LightName(kOff_deg) + (together ? " together" : ""));
      off.views.disturbance.light_off_deg = kOff_deg;
      off.views.disturbance.light_together = together;
      experiment.conditions.push_back(off);
    }
  }
  return experiment;
}

Experiment Exposure(const PaperExperimentOptions& options) {
  Experiment experiment = Base("exposure", options);
  experiment.count_saturated = true;
  for (const int count : options.counts) {
    for (const double stops : options.stops) {
      const std::string folder = stops == 0 ? "" : fmt::format("stops{:+g}", stops);
      Condition condition = Named(Plain(options, count), folder, fmt::format("{:+g} stops", stops));
      condition.views.exposure_stops = stops;
      experiment.conditions.push_back(condition);
    }
  }
  return experiment;
}

Experiment Hdr(const PaperExperimentOptions& options) {
  Experiment experiment = Base("hdr", options);
  for (const int count : options.counts) {
    Condition ldr = Named(Plain(options, count), "", "8 bit");
    Condition hdr = Named(Plain(options, count), "float", "float");
    ldr.views.bits = "8";
    hdr.views.bits = "float";
    experiment.conditions.push_back(ldr);
    experiment.conditions.push_back(hdr);
  }
  return experiment;
}

Experiment TopView(const PaperExperimentOptions& options) {
  Experiment experiment = Base("topview", options);
  for (const int count : options.counts) {
    experiment.conditions.push_back(Named(Plain(options, count), "", "with top view"));
    for (const double tilt : options.tilts) {
      Condition condition = Named(Plain(options, count), fmt::format("tilt{:02g}", tilt),
                                  fmt::format("all ≥ {:g}° off", tilt));
      condition.views.least_tilt_deg = tilt;
      experiment.conditions.push_back(condition);
    }
  }
  return experiment;
}

Experiment Starts(const PaperExperimentOptions& options) {
  Experiment experiment = ByCount("start", options);
  const std::vector<Method> plain = std::move(experiment.methods);
  experiment.methods.clear();
  for (const std::string& start : options.starts) {
    for (const Method& method : plain) experiment.methods.push_back(WithStart(method, start));
  }
  return experiment;
}

Experiment Ablation(const PaperExperimentOptions& options) {
  if (options.weights.empty()) {
    throw UserError("weights: found none; give NAME=FILE of each auto-encoder to compare");
  }
  Experiment experiment = ByCount("ablation", options);
  const std::vector<Method> plain = std::move(experiment.methods);
  experiment.methods.clear();
  for (const auto& [name, file] : ReadNamedWeights(options.weights)) {
    for (Method method : plain) {
      if (method.fit != "latent") {
        throw UserError("methods: found \"" + method.name +
                        "\", which uses no auto-encoder; use latent, refined");
      }
      method.name = name + "-" + method.name;
      method.capture = name + "-" + method.capture;
      method.fit_arguments.insert(method.fit_arguments.end(), {"--weights", file.string()});
      method.files.push_back(file);
      experiment.methods.push_back(method);
    }
  }
  return experiment;
}

std::optional<PaperFigures> PaperOfCount(const ExperimentEntry& mean) {
  const auto row = PaperTable1(mean.count, mean.method);
  if (!mean.condition.empty() || !row) return std::nullopt;
  return PaperFigures{row->maps.average(), row->render};
}

std::string Cell(double value) { return fmt::format("{:.3f}", value); }

// Refined over classic, per number of views, undisturbed and disturbed.
std::string Ratios(const ExperimentResult& result, Json* json) {
  std::string text;
  *json = Json::array();
  for (const ExperimentEntry& mean : result.Means()) {
    if (mean.method != "refined") continue;
    const auto classic = result.Mean(mean.count, mean.condition, "classic");
    if (!classic) continue;
    const auto ratio = [](double a, double b) { return b > 0 ? a / b : 0.0; };
    const double maps = ratio(mean.errors.maps.average(), classic->errors.maps.average());
    const double render = ratio(mean.errors.render, classic->errors.render);
    std::string theirs = "|  |  |";
    Json row = {{"views", mean.count},
                {"disturbed", !mean.condition.empty()},
                {"map_average", maps},
                {"render", render}};
    const auto paper_classic = PaperTable1(mean.count, "classic");
    const auto paper_refined = PaperTable1(mean.count, "refined");
    if (mean.condition.empty() && paper_classic && paper_refined) {
      const double paper_maps = paper_refined->maps.average() / paper_classic->maps.average();
      const double paper_render = paper_refined->render / paper_classic->render;
      theirs = fmt::format("| {} | {} |", Cell(paper_maps), Cell(paper_render));
      row["paper"] = {{"map_average", paper_maps}, {"render", paper_render}};
    }
    text += fmt::format("| {:2} | {:11} | {:11} | {:6} {}\n", mean.count,
                        mean.condition.empty() ? kUndisturbed : mean.condition, Cell(maps),
                        Cell(render), theirs);
    json->push_back(row);
  }
  if (text.empty()) return "";
  return "\nRefined / classic\n\n"
         "|  N | views       | map average | render | paper: map | paper: render |\n"
         "|---:|-------------|------------:|-------:|-----------:|--------------:|\n" +
         text;
}

// The ratios, and the paper's own table in full.
std::string Table1Summary(const ExperimentResult& result, Json* json) {
  ExperimentResult paper;
  for (const ExperimentEntry& mean : result.Means()) {
    const auto row = PaperTable1(mean.count, mean.method);
    if (row && mean.condition.empty()) {
      paper.entries.push_back({"mean", mean.count, "", mean.method, *row, -1});
    }
  }
  Json ratios;
  std::string text = Ratios(result, &ratios);
  *json = {{"refined_over_classic", ratios}, {"paper", paper.ToJson()["means"]}};
  if (paper.entries.empty()) return text;
  return text + "\nGao et al. 2019, on 42 materials of their own\n\n" + paper.Text();
}

// The paper's row for a condition of table 2, by its name.
std::optional<PaperFigures> PaperOfCondition(const std::string& condition) {
  if (condition == kUndisturbed) return PaperTable2(0, 0);
  for (const double strength : kStrengths) {
    if (condition == LightName(strength)) return PaperTable2(strength, 0);
    if (condition == EnvironmentName(strength)) return PaperTable2(0, strength);
  }
  return std::nullopt;
}

std::optional<PaperFigures> PaperOfTable2(const ExperimentEntry& mean) {
  if (mean.count != 20 || mean.method != "refined") return std::nullopt;
  return PaperOfCondition(mean.condition);
}

// Each error over that of the first condition, with the same views and method.
std::string Degradation(const ExperimentResult& result, Json* json) {
  std::string text;
  *json = Json::array();
  const std::string first = result.entries.empty() ? "" : result.entries.front().condition;
  const auto paper_first = PaperOfCondition(first);
  for (const ExperimentEntry& mean : result.Means()) {
    if (mean.condition == first) continue;
    const auto base = result.Mean(mean.count, first, mean.method);
    if (!base || !(base->errors.maps.average() > 0) || !(base->errors.render > 0)) continue;
    const double maps = mean.errors.maps.average() / base->errors.maps.average();
    const double render = mean.errors.render / base->errors.render;
    Json row = {{"views", mean.count},
                {"condition", mean.condition},
                {"method", mean.method},
                {"map_average", maps},
                {"render", render}};
    std::string theirs = "|  |  |";
    const auto paper = PaperOfCondition(mean.condition);
    if (paper && paper_first) {
      const double paper_maps = paper->map_average / paper_first->map_average;
      const double paper_render = paper->render / paper_first->render;
      theirs = fmt::format("| {} | {} |", Cell(paper_maps), Cell(paper_render));
      row["paper"] = {{"map_average", paper_maps}, {"render", paper_render}};
    }
    text += fmt::format("| {:2} | {} | {} | {} | {} {}\n", mean.count, mean.condition, mean.method,
                        Cell(maps), Cell(render), theirs);
    json->push_back(row);
  }
  if (text.empty()) return "";
  return "\nFactors against: " + first +
         "\n\n|  N | condition | method | map average | render | paper: map | paper: render |\n"
         "|---:|---|---|---:|---:|---:|---:|\n" +
         text;
}

}  // namespace

Disturbance EverydayDisturbance() { return {5, 0.5, 5, {}}; }

const std::vector<PaperExperiment>& PaperExperiments() {
  static const std::vector<std::string> three{"classic", "latent", "refined"};
  static const std::vector<std::string> learned{"latent", "refined"};
  static const std::vector<std::string> with_initial{"initial", "latent", "refined"};
  static const std::vector<PaperExperiment> all = {
      {"table1",
       "Errors by number of views and method (table 1 of Gao et al. 2019).",
       "glint-eval table1 --counts 1,5 --work /tmp/table1",
       {1, 2, 5, 20},
       three,
       Table1,
       PaperOfCount,
       Table1Summary},
      {"table2",
       "Errors with incorrect light directions and with ambient illumination (table 2).",
       "glint-eval table2 procedural:1000000000 --environment city.hdr --work /tmp/table2",
       {20},
       {"refined"},
       Table2,
       PaperOfTable2,
       Degradation},
      {"lights",
       "Errors with light directions off by 10°, and the direction error that remains after "
       "correction by glint-refine.",
       "glint-eval lights procedural:1000000000 --work /tmp/lights",
       {20},
       {"uncorrected", "refined"},
       Lights,
       {},
       Degradation},
      {"exposure",
       "Errors by exposure, with the share of saturated texels (fig. 14).",
       "glint-eval exposure procedural:1000000000 --stops=-6,0,2 --work /tmp/exposure",
       {5},
       learned,
       Exposure,
       {},
       {}},
      {"hdr",
       "Errors from 8-bit and from float views (fig. 13).",
       "glint-eval hdr procedural:1000000000 --work /tmp/hdr",
       {5},
       learned,
       Hdr,
       {},
       Degradation},
      {"start",
       "Errors by choice of initial maps (figs. 6 and 16).",
       "glint-eval start procedural:1000000000 --starts heuristic,truth --work /tmp/start",
       {1, 5},
       with_initial,
       Starts,
       {},
       {}},
      {"topview",
       "Errors without a view from above (fig. 17).",
       "glint-eval topview procedural:1000000000 --counts 5 --work /tmp/topview",
       {1, 5},
       with_initial,
       TopView,
       {},
       Degradation},
      {"count",
       "Errors versus number of views (fig. 12).",
       "glint-eval count procedural:1000000000 --work /tmp/count",
       {1, 2, 3, 5, 8, 12, 20},
       three,
       [](const PaperExperimentOptions& options) { return ByCount("count", options); },
       PaperOfCount,
       {}},
      {"ablation",
       "Errors with auto-encoders trained in different ways (figs. 4 and 15).",
       "glint-eval ablation procedural:1000000000 --weights all=a.safetensors,none=b.safetensors "
       "--work /tmp/ablation",
       {1, 2, 5},
       learned,
       Ablation,
       {},
       {}}};
  return all;
}

PaperExperimentOptions Completed(const PaperExperiment& paper, PaperExperimentOptions options) {
  if (options.counts.empty()) options.counts = paper.counts;
  if (options.methods.empty()) options.methods = paper.methods;
  return options;
}

}  // namespace glint
