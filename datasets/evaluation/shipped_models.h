// Which trained weights a result came from, so that it is not kept beyond them.
#pragma once

#include <filesystem>
#include <map>
#include <string>

#include "base/files/json.h"

namespace glint {

// Hashes of the weights that programs find by themselves (FindModel in fitting/weights). A file is
// hashed once.
class ShippedModels {
 public:
  // {NAME: hash} of the inputs of a stage's manifest that are such weights as they are now.
  Json UsedBy(const std::filesystem::path& manifest);
  // Whether all weights in what UsedBy gave are still those.
  bool AreStill(const Json& used);

 private:
  // Empty: there is no such model.
  const std::string& HashOf(const std::string& name);

  std::map<std::string, std::string> hashes_;
};

}  // namespace glint
