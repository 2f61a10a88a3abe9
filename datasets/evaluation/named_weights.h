// Auto-encoders to compare, as verbs take them: NAME=FILE.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace glint {

struct NamedWeights {
  std::string name;            // without '/': files are named after it
  std::filesystem::path file;  // absolute; exists
};

// Throws UserError.
std::vector<NamedWeights> ReadNamedWeights(const std::vector<std::string>& texts);

}  // namespace glint
