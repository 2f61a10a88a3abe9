#include "datasets/evaluation/shipped_models.h"

#include <stdexcept>

#include "base/files/hash.h"
#include "base/formats/manifest.h"
#include "fitting/weights/find_model.h"

namespace glint {

Json ShippedModels::UsedBy(const std::filesystem::path& manifest) {
  const std::string outside = kOutsidePrefix;
  Json used = Json::object();
  for (const ManifestInput& input : ReadManifest(manifest).inputs) {
    if (!input.path.starts_with(outside)) continue;
    const std::string name = input.path.substr(outside.size());
    if (input.hash == HashOf(name)) used[name] = input.hash;
  }
  return used;
}

bool ShippedModels::AreStill(const Json& used) {
  if (!used.is_object()) return false;
  for (const auto& [name, hash] : used.items()) {
    if (hash != HashOf(name)) return false;
  }
  return true;
}

const std::string& ShippedModels::HashOf(const std::string& name) {
  const auto known = hashes_.find(name);
  if (known != hashes_.end()) return known->second;
  std::string hash;
  try {
    hash = HashFile(FindModel(name));
  } catch (const std::runtime_error&) {
    // Not one of ours, or no longer there.
  }
  return hashes_[name] = hash;
}

}  // namespace glint
