// Where Glint's programs lie and what each is for.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace glint {

// The program's file: beside the running program first, then in PATH; empty: not found.
std::filesystem::path FindProgram(const std::string& name);

// FindProgram ("glint-fit"). Throws EnvironmentError when missing.
std::filesystem::path RequireGlintProgram(const std::string& name);

struct ProgramVerb {
  std::string name;     // "fit"
  std::string summary;  // one line; empty for programs that Glint does not know
};

// Every verb whose program is there, Glint's own in the order of the work, others after them.
std::vector<ProgramVerb> ListVerbs();

// The verb of `verbs` closest in spelling; empty: none is close.
std::string ClosestVerb(const std::string& mistyped, const std::vector<ProgramVerb>& verbs);

}  // namespace glint
