// What Glint's programs say of themselves with --describe: for completion and manual pages, which
// so never lag behind the programs.
#pragma once

#include <string>
#include <vector>

#include "base/files/json.h"

namespace glint {

// A line of the command line that takes options: "run", or "synth capture".
struct DescribedCommand {
  std::vector<std::string> words;
  std::string description, footer;
  Json options;  // OptionSet::Describe; null: a program whose options are its verbs'
};

// Of every program beside this one and in PATH that answers. In the order of ListVerbs.
std::vector<DescribedCommand> DescribeCommands();

// The options that all programs share, as OptionSet::Describe has them.
Json CommonOptionList();

}  // namespace glint
