// glint-demo: a synthetic capture, every stage on it, and the errors relative to ground truth.
#include <cstdio>
#include <filesystem>
#include <string>
#include <vector>

#include "base/errors/errors.h"
#include "base/programs/program.h"
#include "pipeline/driver/child_process.h"
#include "pipeline/driver/programs.h"

namespace {

namespace fs = std::filesystem;

// A step that fails has said why.
void Step(const std::string& title, const std::string& program, std::vector<std::string> words) {
  std::printf("\n%s\n", title.c_str());
  words.insert(words.begin(), glint::RequireGlintProgram(program).string());
  glint::ChildProcess child;
  child.arguments = std::move(words);
  const int code = glint::RunChild(child);
  if (code != 0) throw glint::Error(static_cast<glint::ExitCode>(code), "");
}

glint::ProgramResult Demo(const fs::path& folder) {
  if (!fs::exists(folder / "capture.toml")) {
    std::error_code error;
    if (fs::exists(folder) && !fs::is_empty(folder, error)) {
      throw glint::UserError(folder, "", "a folder that holds other things",
                             "name one that does not exist yet");
    }
    Step("A synthetic capture: 12 photographs of a board with a leather sample in it",
         "glint-synth",
         {"capture", folder.string(), "--family", "leather", "--seed", "3", "--resolution", "512"});
  }
  Step("Every stage on it", "glint-run", {folder.string()});
  const fs::path work = folder / "glint", truth = folder / "truth";
  Step("Errors of the cameras relative to ground truth", "glint-eval",
       {"cameras", truth.string(), (work / "calib/manifest.json").string()});
  Step("Errors of the maps relative to ground truth", "glint-eval",
       {"maps", (work / "refine/svbrdf.exr").string(), (truth / "svbrdf.exr").string()});
  const fs::path whole = fs::absolute(folder);
  const std::string page = (whole / "glint/report/index.html").string();
  const std::string files = (whole / "glint/export").string();
  return {"\nDone. Look at:\n  page    " + page +
              "   (relight it, compare it with its photographs)\n  files   " + files +
              "   (maps, glTF, MaterialX, USD, Blender)\n  truth   " + (whole / "truth").string(),
          {{"page", page}, {"files", files}}};
}

}  // namespace

int main(int argc, char** argv) {
  fs::path folder;
  glint::OptionSet options;
  options.AddPositional("DIR", &folder, "folder of the new capture", true);
  return glint::RunProgram(
      argc, argv,
      {"glint-demo",
       "Makes a synthetic phone capture, runs every stage on it and compares the result with "
       "ground truth.",
       GLINT_VERSION, "Example: glint demo leather && glint view leather", false},
      &options, [&](const glint::CommonOptions&) { return Demo(folder); });
}
