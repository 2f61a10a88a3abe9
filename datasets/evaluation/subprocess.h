// Running one of Glint's programs and waiting for it.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace glint {

// The program `name` beside the one that runs. Throws EnvironmentError when there is none.
std::filesystem::path SiblingProgram(const std::string& name);

// Runs argv[0] with stdout and stderr appended to `log`. Throws ComputationError, with the last
// lines of what it said, when it ends with another exit code than 0; EnvironmentError when it
// cannot start.
void RunToLog(const std::vector<std::string>& argv, const std::filesystem::path& log);

}  // namespace glint
