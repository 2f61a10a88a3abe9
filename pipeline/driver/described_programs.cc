#include "pipeline/driver/described_programs.h"

#include <utility>

#include "base/programs/program.h"
#include "pipeline/driver/child_process.h"
#include "pipeline/driver/programs.h"

namespace glint {
namespace {

// Null where the program does not answer: it is not of this version, or no program of Glint's.
Json Ask(std::vector<std::string> arguments) {
  arguments.push_back(kDescribeFlag);
  std::string out;
  ChildProcess child;
  child.arguments = std::move(arguments);
  child.on_line = [&](const std::string& line) { out += line + "\n"; };
  child.quiet_stderr = true;
  if (RunChild(child) != 0) return nullptr;
  const Json answer = Json::parse(out, nullptr, false);
  return answer.is_object() && answer.contains("program") ? answer : Json();
}

DescribedCommand CommandOf(std::vector<std::string> words, const Json& answer) {
  return {std::move(words), answer.value("description", ""), answer.value("footer", ""),
          answer.value("options", Json())};
}

}  // namespace

std::vector<DescribedCommand> DescribeCommands() {
  std::vector<DescribedCommand> commands;
  for (const ProgramVerb& verb : ListVerbs()) {
    const std::string program = FindProgram("glint-" + verb.name).string();
    const Json answer = Ask({program});
    if (answer.is_null()) continue;
    commands.push_back(CommandOf({verb.name}, answer));
    if (!answer.contains("verbs")) continue;
    for (const Json& inner : answer["verbs"]) {
      const auto name = inner["verb"].get<std::string>();
      const Json described = Ask({program, name});
      if (!described.is_null()) commands.push_back(CommandOf({verb.name, name}, described));
    }
  }
  return commands;
}

Json CommonOptionList() {
  CommonOptions common;
  Json list = CommonOptionSet(&common).Describe();
  // Those that the command line's parser adds.
  for (const auto& [name, help] : {std::pair{"help", "print help and exit"},
                                   std::pair{"version", "print the version and exit"}}) {
    list.push_back({{"name", name}, {"help", help}, {"kind", "flag"}, {"positional", false}});
  }
  return list;
}

}  // namespace glint
