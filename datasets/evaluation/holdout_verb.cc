#include "datasets/evaluation/holdout_verb.h"

#include <spdlog/spdlog.h>

#include "base/errors/errors.h"
#include "base/files/files.h"
#include "datasets/evaluation/held_out_sheet.h"
#include "datasets/evaluation/held_out_views.h"

namespace glint {
namespace {

namespace fs = std::filesystem;

// NAME=FOLDER.
ProgramFolder ParsePrograms(const std::string& text) {
  const size_t equals = text.find('=');
  if (equals == std::string::npos || equals == 0 || equals + 1 == text.size()) {
    throw UserError("programs: found \"" + text + "\"; write NAME=FOLDER");
  }
  ProgramFolder programs{text.substr(0, equals), text.substr(equals + 1)};
  for (const char* name : {"glint-fit", "glint-refine"}) {
    if (!fs::exists(programs.folder / name)) {
      throw UserError(programs.folder, "", std::string("no ") + name,
                      "name a folder with built programs, such as build/bin");
    }
  }
  return programs;
}

void WriteResult(const HoldoutExperiment& experiment, const HoldoutResult& result, int threads) {
  const fs::path& work = experiment.work;
  WriteFileAtomically(work / "holdout.csv", result.Csv());
  WriteFileAtomically(work / "holdout.json", result.ToJson().dump(2) + "\n");
  WriteFileAtomically(work / "holdout.md", result.Markdown());
  const std::string& method = experiment.methods.back();
  for (const HoldoutSplit& split : experiment.splits) {
    WritePng(work / ("holdout_" + split.folder + ".png"),
             DrawHeldOutSheet(result, split.name, method, threads));
  }
}

int RunHoldoutVerb(int argc, char** argv, const ProgramInfo& info) {
  HoldoutExperiment experiment;
  experiment.methods = {"initial", "classic", "latent", "refined"};
  std::vector<std::string> sets, programs;
  std::string pairs, fitted;
  OptionSet options;
  options.AddPositional("sets", &sets,
                        "folders that glint-import reads, or captures with rectified views", true);
  options.Add("work", &experiment.work, "folder in which captures and results are kept (required)");
  options.Add("pairs", &pairs,
              "views to hold out, by number (from 0) or by name; separate groups with ';', as in "
              "'2,6;7,8'");
  options.Add("shown", &fitted,
              "views to fit; all others are held out; numbers, names and groups as in --pairs");
  options.AddRange("size", &experiment.size, 0, 16384,
                   "width in texels at which sets are imported; 0: the images' width");
  options.Add(
      "methods", &experiment.methods,
      "any of: initial (the initial maps, unfitted), classic, latent, refined, direct (the initial "
      "maps, refined)");
  options.Add("programs", &programs,
              "other builds to compare with, as NAME=FOLDER,…; FOLDER holds the build's programs");
  options.Add("import-args", &experiment.import_arguments,
              "additional arguments for glint-import, comma-separated");
  options.Add("fit-args", &experiment.fit_arguments,
              "additional arguments for glint-fit, comma-separated");
  options.Add("refine-args", &experiment.refine_arguments,
              "additional arguments for glint-refine, comma-separated");
  return RunProgram(argc, argv, info, &options, [&](const CommonOptions& common) {
    if (common.check) throw UserError("status: an experiment is not a stage; leave the option out");
    experiment.sets.assign(sets.begin(), sets.end());
    experiment.splits = ParseSplits(pairs, false);
    for (const HoldoutSplit& split : ParseSplits(fitted, true)) experiment.splits.push_back(split);
    for (const std::string& text : programs) experiment.programs.push_back(ParsePrograms(text));
    const HoldoutResult result =
        RunHoldout(experiment, common, [](const std::string& text) { spdlog::info("{}", text); });
    WriteResult(experiment, result, common.threads);
    return ProgramResult{result.Markdown(), result.ToJson()};
  });
}

}  // namespace

Verb HoldoutVerb() {
  return {"holdout",
          "Fits maps to some photographs of real captures and compares renderings with the "
          "held-out photographs.",
          "Example: glint-eval holdout sets/cards sets/wood --pairs '2,6;7,8' --shown 0 --work h",
          RunHoldoutVerb};
}

}  // namespace glint
