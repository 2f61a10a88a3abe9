#include "datasets/evaluation/experiment_verbs.h"

#include <spdlog/spdlog.h>

#include "datasets/evaluation/paper_experiments.h"

namespace glint {
namespace {

constexpr int kOwnMaterials = 8;

void AddOptions(const PaperExperiment& paper, PaperExperimentOptions* experiment,
                std::vector<double>* counts, OptionSet* options) {
  options->AddPositional("materials", &experiment->materials,
                         "maps, folders of materials, procedural:SEED or procedural:FIRST..LAST; "
                         "if omitted: eight reserved seeds",
                         false);
  options->Add("counts", counts, "numbers of views");
  options->Add("methods", &experiment->methods,
               "any of: initial (the initial maps, unfitted), classic (texel by texel), latent, "
               "refined (latent, then glint-refine), direct (initial, then glint-refine), "
               "uncorrected (refined without correcting the views)");
  options->Add("work", &experiment->work, "folder in which views and results are kept (required)");
  options->AddRange("size", &experiment->size, 8, 4096, "texels per side");
  ViewSetOptions* views = &experiment->views;
  options->AddChoice("rule", &views->rule, {"dir", "photo", "flash"}, "as in glint-synth views");
  options->AddRange("discrepancy", &views->discrepancy, 0, 2, "as in glint-synth views");
  if (paper.name != "hdr") {
    options->AddChoice("bits", &views->bits, {"8", "float"}, "as in glint-synth views");
  }
  options->AddChoice("encoding", &views->encoding, {"gamma2.2", "srgb", "linear"},
                     "as in glint-synth views");
  options->Add("fit-args", &experiment->fit_arguments,
               "additional arguments for glint-fit, comma-separated");
  options->Add("refine-args", &experiment->refine_arguments,
               "additional arguments for glint-refine, comma-separated");
  if (paper.name == "table1") {
    options->Add("disturb", &experiment->disturb,
                 "also evaluate with disturbed views: registration off by 0.5 texel, light by 5°, "
                 "ambient illumination of 5 %");
  }
  if (paper.name == "table1" || paper.name == "table2") {
    options->Add(
        "environment", &views->disturbance.environment,
        "equirectangular radiance map, .hdr or .exr (default: uniform white surroundings)");
  }
  if (paper.name == "exposure") {
    options->Add("stops", &experiment->stops, "exposures in stops, as in --stops=-6,0,2");
  }
  if (paper.name == "topview") {
    options->Add("tilts", &experiment->tilts, "minimum angles from the normal, in degrees");
  }
  if (paper.name == "start") {
    options->Add("starts", &experiment->starts,
                 "initial maps, any of: random (in blocks), heuristic (rules), network (the "
                 "trained estimator), truth, rough (the truth, rougher and less specular)");
  }
  if (paper.name == "ablation") {
    options->Add("weights", &experiment->weights, "NAME=FILE of each auto-encoder (required)");
  }
}

std::vector<int> Whole(const std::vector<double>& numbers) {
  std::vector<int> whole;
  for (const double number : numbers) {
    if (number != static_cast<int>(number)) {
      throw UserError("counts: found " + std::to_string(number) + "; use whole numbers");
    }
    whole.push_back(static_cast<int>(number));
  }
  return whole;
}

int RunVerb(const PaperExperiment& paper, int argc, char** argv, const ProgramInfo& info) {
  PaperExperimentOptions given;
  std::vector<double> counts(paper.counts.begin(), paper.counts.end());
  given.methods = paper.methods;
  OptionSet options;
  AddOptions(paper, &given, &counts, &options);
  return RunProgram(argc, argv, info, &options, [&](const CommonOptions& common) {
    if (given.work.empty()) throw UserError("work: found nothing; name a folder for the results");
    if (common.check) throw UserError("status: an experiment is not a stage; leave the option out");
    given.counts = Whole(counts);
    Experiment experiment = paper.make(Completed(paper, given));
    experiment.materials = experiment.materials.empty() ? ReservedMaterials(kOwnMaterials)
                                                        : ExpandMaterials(experiment.materials);
    const ExperimentResult result = RunExperiment(
        experiment, common, [](const std::string& text) { spdlog::info("{}", text); });
    Json json = result.ToJson();
    std::string text = result.Text(paper.paper);
    if (paper.summary) text += paper.summary(result, &json["summary"]);
    WriteExperiment(experiment, result, paper.paper, json, common.threads);
    return ProgramResult{text, json};
  });
}

}  // namespace

std::vector<Verb> ExperimentVerbs() {
  std::vector<Verb> verbs;
  for (const PaperExperiment& paper : PaperExperiments()) {
    verbs.push_back({paper.name, paper.description, "Example: " + paper.example,
                     [&paper](int argc, char** argv, const ProgramInfo& info) {
                       return RunVerb(paper, argc, argv, info);
                     }});
  }
  return verbs;
}

}  // namespace glint
