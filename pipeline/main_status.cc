// glint-status: which results are up to date.
#include "base/programs/program.h"
#include "pipeline/driver/kept_options.h"
#include "pipeline/driver/ninja_file.h"
#include "pipeline/driver/status.h"

int main(int argc, char** argv) {
  std::filesystem::path folder = ".";
  glint::OptionSet options;
  options.AddPositional("CAPTURE", &folder, "folder of the capture", false);
  return glint::RunProgram(
      argc, argv,
      {"glint-status",
       "Shows for each stage whether its result is up to date with the options of the last glint "
       "run (and if not, why), its size and its key numbers.",
       GLINT_VERSION, "", false},
      &options, [&](const glint::CommonOptions&) -> glint::ProgramResult {
        const glint::Capture capture = glint::ReadCapture(folder);
        const auto choices = glint::ReadChoices(capture.work() / "build.ninja");
        auto steps = glint::StageSteps(capture, choices);
        glint::KeepOptions(capture, &steps);
        const auto status = glint::LookAtCapture(capture, steps);
        return {status.BriefReport(), status.ToJson()};
      });
}
