// glint-run: every stage that is not up to date.
#include <string>

#include "base/errors/errors.h"
#include "base/programs/program.h"
#include "base/stages/stages.h"
#include "pipeline/driver/kept_options.h"
#include "pipeline/driver/run.h"
#include "pipeline/driver/status.h"

namespace {

struct RunArguments {
  glint::RunOptions run;
  bool dry_run = false;
  bool quick = false;
  int jobs = 0;
};

void AddOptions(glint::OptionSet* options, RunArguments* o) {
  options->AddPositional("CAPTURE", &o->run.capture, "folder of the capture", false);
  options->Add("from", &o->run.from, "start at this stage; keep earlier results");
  options->Add("until", &o->run.until, "stop after this stage");
  options->Add("dry-run", &o->dry_run,
               "list the stages that would run, and why, without running them");
  options->AddRange("jobs,-j", &o->jobs, 0, 1024, "same as --threads");
  options->AddChoice(
      "method", &o->run.choices.method, {"initial", "classic", "latent", "refined"},
      "initial: maps as estimated by a network, without fitting; classic: maps fitted texel by "
      "texel; latent: maps fitted in the auto-encoder's latent space; refined (default): latent, "
      "then refined texel by texel");
  options->Add("quick", &o->quick,
               "a first look in seconds, before you put the sample away: the same as "
               "--method initial; run again without it to fit the maps");
  options->Add("exclude", &o->run.choices.exclude,
               "photographs (file or view names) held out from fit and refine");
  options->Add("views", &o->run.choices.views, "use only these photographs in fit and refine");
  options->Add("verbose,-v", &o->run.verbose, "show everything that the stages and Ninja print");
}

glint::ProgramResult DryRun(const RunArguments& o) {
  const glint::Capture capture = glint::ReadCapture(o.run.capture);
  auto steps =
      glint::SelectSteps(glint::StageSteps(capture, o.run.choices), o.run.from, o.run.until);
  glint::KeepOptions(capture, &steps);
  const glint::CaptureStatus status = glint::LookAtCapture(capture, steps);
  return {status.Plan(), status.ToJson()};
}

void ApplyQuick(RunArguments* o) {
  std::string& method = o->run.choices.method;
  if (!o->quick) return;
  if (!method.empty() && method != "initial") {
    throw glint::UserError("--quick: found with --method " + method + "; give one of the two");
  }
  method = "initial";
}

int ThreadsForStages(int argc, char** argv, const glint::CommonOptions& common, int jobs) {
  if (jobs > 0) return jobs;
  for (int i = 1; i < argc; ++i) {
    if (std::string(argv[i]).rfind("--threads", 0) == 0) return common.threads;
  }
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  RunArguments o;
  glint::OptionSet options;
  AddOptions(&options, &o);
  return glint::RunProgram(
      argc, argv,
      {"glint-run",
       "Runs every out-of-date stage of a capture: " + glint::StageNamesText() +
           " (tile: with a [tile] section in capture.toml).",
       GLINT_VERSION,
       "Examples:\n  glint run wood\n  glint run wood --quick\n  glint run wood --until rectify\n"
       "  glint run wood --exclude img_003.jpg,img_007.jpg --method latent"},
      &options, [&](const glint::CommonOptions& common) -> glint::ProgramResult {
        o.run.force = common.force;
        o.run.choices.seed = common.seed;
        ApplyQuick(&o);
        if (o.dry_run || common.check) return DryRun(o);
        o.run.threads = ThreadsForStages(argc, argv, common, o.jobs);
        o.run.memory_gb = common.memory_gb;
        o.run.log_level = common.log_level;
        o.run.quiet_stdout = common.json;
        const glint::RunSummary summary = glint::RunCapture(o.run);
        return {summary.BriefReport(), summary.ToJson()};
      });
}
