// The tables and figures of Gao et al. 2019 ("DIR") as experiments. Each is one verb of glint-eval.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "datasets/evaluation/experiment.h"
#include "datasets/evaluation/plot.h"

namespace glint {

struct PaperExperimentOptions {
  std::vector<std::string> materials;  // as ExpandMaterials takes them
  std::vector<int> counts;             // numbers of views; empty: the experiment's own
  std::vector<std::string> methods;  // start, classic, latent, refined; empty: the experiment's own
  std::filesystem::path work;
  int size = 256;
  ViewSetOptions views;  // its count is replaced
  std::vector<std::string> fit_arguments, refine_arguments;
  bool disturb = false;                                // table1: once more with disturbed views
  std::vector<double> stops{-6, -4, -2, -1, 0, 1, 2};  // exposure
  std::vector<double> tilts{20, 30, 45};               // topview, degrees
  std::vector<std::string> starts{"random", "heuristic", "network", "truth", "rough"};  // start
  std::vector<std::string> weights;  // ablation: NAME=FILE
};

// What one verb does beside running its experiments.
struct PaperExperiment {
  std::string name, description, example;
  std::vector<int> counts;           // by default
  std::vector<std::string> methods;  // likewise
  // Throws UserError.
  std::function<Experiment(const PaperExperimentOptions&)> make;
  // The paper's figures for a mean; none: it has none in numbers.
  ExperimentResult::Paper paper;
  // A last block below the table, and its figures.
  std::function<std::string(const ExperimentResult&, Json*)> summary;
};

// table1, table2, lights, exposure, hdr, start, topview, count, ablation.
const std::vector<PaperExperiment>& PaperExperiments();

// Names the conditions' strengths in table1 --disturb: registration off by 0.5 texel, light by 5°,
// environment light of 5 %, together.
Disturbance EverydayDisturbance();
inline constexpr char kDisturbed[] = "disturbed";

// Options completed by the experiment's own counts and methods.
PaperExperimentOptions Completed(const PaperExperiment& paper, PaperExperimentOptions options);

// Map average and render error over the number of views; with one such number over the conditions,
// with one of both over the methods. A line a method, and dashed the paper's.
Plot PlotOf(const ExperimentResult& result, const ExperimentResult::Paper& paper);

// Writes NAME.csv, NAME.json, NAME.svg and NAME.png into the experiment's work folder; `json` is
// what NAME.json gets. Throws EnvironmentError.
void WriteExperiment(const Experiment& experiment, const ExperimentResult& result,
                     const ExperimentResult::Paper& paper, const Json& json, int threads);

}  // namespace glint
