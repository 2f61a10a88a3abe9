// glint-view: opens the report page.
#include <filesystem>

#include "base/errors/errors.h"
#include "base/formats/capture.h"
#include "base/programs/program.h"
#include "base/programs/subprocess.h"

namespace {

namespace fs = std::filesystem;

glint::ProgramResult View(const fs::path& folder, bool print) {
  const glint::Capture capture = glint::ReadCapture(folder);
  const fs::path page = fs::absolute(capture.work() / "report" / "index.html").lexically_normal();
  if (!fs::exists(page)) {
    throw glint::UserError(page, "", "no page", "make it with: glint run " + folder.string());
  }
  const glint::Json json = {{"page", page.string()}};
  if (print) return {page.string(), json};
  glint::OpenOnDesktop(page.string());
  return {"opened " + page.string(), json};
}

}  // namespace

int main(int argc, char** argv) {
  fs::path folder = ".";
  bool print = false;
  glint::OptionSet options;
  options.AddPositional("CAPTURE", &folder, "folder of the capture", false);
  options.Add("print", &print, "print the page's path instead of opening it");
  return glint::RunProgram(
      argc, argv,
      {"glint-view", "Opens a capture's result page, on which the material can be relit.",
       GLINT_VERSION, "Example: glint view wood", false},
      &options, [&](const glint::CommonOptions&) { return View(folder, print); });
}
