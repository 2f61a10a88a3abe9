// `glint <verb> …` runs `glint-<verb> …`, as git does.
#pragma once

#include <string>

namespace glint {

// Returns the exit code; does not return when a program takes over.
int Dispatch(int argc, char** argv, const std::string& version);

}  // namespace glint
