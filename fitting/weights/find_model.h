// Where trained weights lie at run time.
#pragma once

#include <filesystem>
#include <string>

namespace glint {

// Where a trained file of fitting/models lies at run time. Looked for in this order: `given` (when
// not empty), $GLINT_MODELS/NAME, ../share/glint/models and ../../fitting/models beside the running
// program, the source tree of the build. Throws std::runtime_error that lists the places.
std::filesystem::path FindModel(const std::string& name, const std::filesystem::path& given = {});

}  // namespace glint
