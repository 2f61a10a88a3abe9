#include "pipeline/driver/described_programs.h"

#include "pipeline/contract/program.h"
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
  const auto flag = [](const char* name, const char* help) -> Json {
    return {{"name", name}, {"help", help}, {"kind", "flag"}, {"positional", false}};
  };
  return {{{"name", "threads"},
           {"help", "threads to use; 0: one a core; never changes a result"},
           {"kind", "integer"},
           {"positional", false},
           {"default", "0"}},
          {{"name", "seed"},
           {"help", "seed of everything random"},
           {"kind", "integer"},
           {"positional", false},
           {"default", "0"}},
          {{"name", "log-level"},
           {"help", "what is said on stderr"},
           {"kind", "text"},
           {"positional", false},
           {"choices", {"debug", "info", "warning", "error", "off"}},
           {"default", "info"}},
          flag("json", "write the result to stdout as JSON"),
          flag("force", "compute although the result is up to date"),
          flag("status", "only say whether the result is up to date"),
          flag("help", "print help and exit"),
          flag("version", "print the version and exit")};
}

}  // namespace glint
