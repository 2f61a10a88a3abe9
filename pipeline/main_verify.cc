// glint-verify: whether results on disk are what their stages wrote.
#include <cstdio>

#include "base/errors/errors.h"
#include "base/programs/program.h"
#include "pipeline/driver/verify.h"

int main(int argc, char** argv) {
  std::filesystem::path folder = ".";
  bool intact = true;
  glint::OptionSet options;
  options.AddPositional("CAPTURE", &folder, "folder of the capture", false);
  const int code = glint::RunProgram(
      argc, argv,
      {"glint-verify",
       "Compares every file under CAPTURE/glint, and the inputs it was made from, with the hashes "
       "recorded in the manifests. Exit code 1: something has changed.",
       GLINT_VERSION, "", false},
      &options, [&](const glint::CommonOptions&) -> glint::ProgramResult {
        const glint::Verification verification = glint::VerifyCapture(folder);
        intact = verification.intact();
        return {verification.Text(), verification.ToJson()};
      });
  return code == 0 && !intact ? glint::kExitComputation : code;
}
