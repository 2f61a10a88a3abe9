// What Glint reads that anyone may have written: one target a format of files, and one for what
// Glint Studio is sent.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace glint::fuzz {

struct FuzzTarget {
  std::string name;  // of its folder in corpora/ too
  // Reads `bytes`, as a file in `folder`, which is the caller's to remove. Throws glint::Error for
  // what is no such file; anything else thrown, and any crash, is a finding.
  std::function<void(const std::filesystem::path& folder, std::string_view bytes)> read;
  // How often ./dev test cuts off each file of the corpus, and how often it changes it.
  int replays = 100;
};

const std::vector<FuzzTarget>& FuzzTargets();

// Throws std::out_of_range for a name that no target has.
const FuzzTarget& FindFuzzTarget(const std::string& name);

// Whether `target` takes `bytes` for a file of its format. Passes on what is a finding.
bool Accepts(const FuzzTarget& target, const std::filesystem::path& folder, std::string_view bytes);

}  // namespace glint::fuzz
