// `glint verify`: whether everything below CAPTURE/glint is as its stages wrote it, byte for byte.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "base/files/json.h"

namespace glint {

struct StageFindings {
  std::string stage;
  size_t files = 0;                   // that were compared: outputs and inputs
  std::vector<std::string> problems;  // in words; none: all is well
};

struct Verification {
  std::filesystem::path capture;
  std::vector<StageFindings> stages;  // that have a result, by name

  bool intact() const;
  std::string Text() const;
  Json ToJson() const;
};

// Compares every manifest with its seal, every output and every input within the capture with its
// hash. Options and versions are not compared: `glint status` does that. Throws UserError: no
// results.
Verification VerifyCapture(const std::filesystem::path& capture);

}  // namespace glint
