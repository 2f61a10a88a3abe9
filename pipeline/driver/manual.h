// Manual pages (man 1 glint-run) from what the programs say of themselves.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "pipeline/driver/described_programs.h"

namespace glint {

// A page in roff, of a command and the verbs within it.
std::string ManualPage(const DescribedCommand& command,
                       const std::vector<DescribedCommand>& verbs_within,
                       const std::string& version);

// The page of `glint` itself.
std::string OverviewPage(const std::vector<DescribedCommand>& commands, const std::string& version);

// Writes glint.1 and glint-*.1 into `folder`, which is made. Returns the files.
std::vector<std::filesystem::path> WriteManual(const std::filesystem::path& folder,
                                               const std::vector<DescribedCommand>& commands,
                                               const std::string& version);

}  // namespace glint
