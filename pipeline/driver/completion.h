// Scripts by which shells complete verbs, options, choices and files.
#pragma once

#include <string>
#include <vector>

#include "pipeline/driver/described_programs.h"

namespace glint {

// "bash", "zsh", "fish".
const std::vector<std::string>& CompletionShells();

// Throws UserError for another shell.
std::string CompletionScript(const std::string& shell,
                             const std::vector<DescribedCommand>& commands);

}  // namespace glint
