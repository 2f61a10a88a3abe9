// glint-manual: manual pages.
#include <filesystem>

#include "base/programs/program.h"
#include "pipeline/driver/manual.h"

int main(int argc, char** argv) {
  std::filesystem::path folder;
  glint::OptionSet options;
  options.AddPositional("FOLDER", &folder, "where to write glint.1, glint-run.1 and the others",
                        true);
  return glint::RunProgram(
      argc, argv,
      {"glint-manual", "Writes manual pages: one for glint and one for each verb.", GLINT_VERSION,
       "Example: glint manual ~/.local/share/man/man1 && man glint-run", false},
      &options, [&](const glint::CommonOptions&) -> glint::ProgramResult {
        const auto files = glint::WriteManual(folder, glint::DescribeCommands(), GLINT_VERSION);
        glint::Json list = glint::Json::array();
        for (const auto& file : files) list.push_back(file.string());
        return {std::to_string(files.size()) + " manual pages in " + folder.string(),
                {{"files", list}}};
      });
}
