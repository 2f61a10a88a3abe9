#include "datasets/evaluation/light_verb.h"

#include "base/errors/errors.h"
#include "datasets/evaluation/light_experiment.h"

namespace glint {
namespace {

int RunLight(int argc, char** argv, const ProgramInfo& info) {
  LightExperimentOptions experiment;
  experiment.capture = PhoneCapture();
  CapturePlanOptions& plan = experiment.capture.plan;
  OptionSet options;
  options.Add("work", &experiment.work, "folder in which captures and results are kept (required)");
  options.AddRange("seeds", &experiment.seeds, 1, 10000, "number of captures");
  options.AddRange("first-seed", &experiment.first_seed, 0, 1e9, "seed of the first capture");
  options.AddRange("map-seeds", &experiment.map_seeds, 0, 10000,
                   "number of these captures for which maps are also fitted, with --light board "
                   "and with --light camera");
  options.AddRange("resolution", &experiment.resolution, 16, 4096, "texels per side of the maps");
  options.AddRange("photos", &plan.photos, 1, 1000, "number of photographs per capture");
  options.AddRange("megapixels", &plan.megapixels, 0.05, 60, "size of a photograph");
  options.AddRange("vignetting", &plan.vignetting, 0, 0.8,
                   "fraction of the light lost in the picture's corners");
  options.AddRange("exposure-ev", &plan.exposure_ev, 0, 4, "spread of the exposures, in stops");
  options.AddRange("ambient", &plan.ambient, 0, 10, "ambient illumination relative to the flash");
  options.Add("fit-args", &experiment.fit_arguments,
              "additional arguments for glint-fit, comma-separated");
  options.Add("refine-args", &experiment.refine_arguments,
              "additional arguments for glint-refine, comma-separated");
  return RunProgram(argc, argv, info, &options, [&](const CommonOptions& common) {
    if (experiment.work.empty()) {
      throw UserError("work: found nothing; name a folder for the results");
    }
    if (common.check) throw UserError("status: an experiment is not a stage; leave the option out");
    experiment.again = common.force;
    const LightExperimentResult result = RunLightExperiment(experiment, common.threads);
    return ProgramResult{result.Text(), result.ToJson()};
  });
}

}  // namespace

Verb LightVerb() {
  return {"light",
          "Calibrates the light of synthetic phone captures from the board and compares it with "
          "ground truth: errors, and how often they lie within the stated standard deviations.",
          "Example: glint-eval light --work light --seeds 20 --map-seeds 3", RunLight};
}

}  // namespace glint
