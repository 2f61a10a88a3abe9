// An experiment: views of materials under several conditions, maps from them by several methods,
// and their errors. The verbs of glint-eval that repeat the paper's tables and figures are each one
// Experiment (paper_experiments.h); this runs it with the programs and keeps what is done.
//
// On disk, below `work`:
//   MATERIAL/CONDITION/CAPTURE/        a capture: photos, truth, glint/{rectify,fit,refine}
//   MATERIAL/CONDITION/METHOD.json     settings and errors: a result that is done
//   MATERIAL/CONDITION/CAPTURE.log     what the programs said
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "base/files/json.h"
#include "base/programs/program.h"
#include "datasets/evaluation/experiment_result.h"
#include "datasets/synth/view_set.h"

namespace glint {

// How the views are made.
struct Condition {
  std::string folder;  // "n05", "n20_light05"
  std::string name;    // in tables: "light off by 5°"; empty where the number of views says all
  ViewSetOptions views;
};

// How maps are made from them.
struct Method {
  std::string name;            // in tables and of the result's file: "refined"
  std::string capture;         // folder of the capture; methods that share a result share it
  std::string fit_of;          // folder of the capture whose fit it takes over; empty: its own
  std::string fit = "latent";  // glint-fit --method
  bool refine = false;         // and glint-refine on that
  std::vector<std::string> fit_arguments, refine_arguments;
  std::vector<std::filesystem::path> files;  // that the arguments name: a result depends on them
  // Maps to start from (glint-fit --start), made from the truth; none: the program's own start.
  std::function<SvbrdfMaps(const SvbrdfMaps& truth)> start;
};

// initial (the initial maps, unfitted), classic (texel by texel), latent, refined (latent, then
// glint-refine), direct (initial, then glint-refine) or uncorrected (refined without correcting the
// views). Throws UserError for other names.
Method NamedMethod(const std::string& name, const std::vector<std::string>& fit_arguments,
                   const std::vector<std::string>& refine_arguments);

struct Experiment {
  std::string name;                    // of the verb
  std::vector<std::string> materials;  // as LoadMaterial takes them
  std::vector<Condition> conditions;
  std::vector<Method> methods;
  std::filesystem::path work;
  int size = 256;                // texels a side
  bool count_saturated = false;  // measure the share of saturated texels of the views
  bool compare_lights = false;   // measure how far refine's lights are from the true ones
};

// Materials from what a person names: maps, procedural:SEED, procedural:FIRST..LAST (all seeds
// between), folders of maps, folders that hold such folders (all of them, sorted). Throws
// UserError; also when two have one name, since results are kept by name.
std::vector<std::string> ExpandMaterials(const std::vector<std::string>& named);

// Resumable: a finished result is kept and not computed again as long as its settings, the true
// maps and the weights that it came from are the same, unless common.force. `said` is told of each
// step. Throws what the programs ended with.
ExperimentResult RunExperiment(const Experiment& experiment, const CommonOptions& common,
                               const std::function<void(const std::string&)>& said);

// Manifest of the maps that `method` made.
std::filesystem::path ResultManifest(const Experiment& experiment, const std::string& material,
                                     const Condition& condition, const Method& method);

}  // namespace glint
