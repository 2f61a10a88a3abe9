// glint-estimate: what a run will cost.
#include "base/programs/program.h"
#include "pipeline/driver/estimate.h"
#include "pipeline/driver/ninja_file.h"

int main(int argc, char** argv) {
  std::filesystem::path folder = ".";
  glint::OptionSet options;
  options.AddPositional("CAPTURE", &folder, "folder of the capture", false);
  return glint::RunProgram(
      argc, argv,
      {"glint-estimate",
       "Estimates the time and peak memory of every stage of glint run from the number and size of "
       "the photographs and maps.",
       GLINT_VERSION, "Example: glint estimate wood --json", false},
      &options, [&](const glint::CommonOptions& common) -> glint::ProgramResult {
        const glint::Capture capture = glint::ReadCapture(folder);
        const auto choices = glint::ReadChoices(capture.work() / "build.ninja");
        const auto estimate =
            glint::EstimateCapture(capture, glint::StageSteps(capture, choices), common.threads);
        return {estimate.ToText(), estimate.ToJson()};
      });
}
