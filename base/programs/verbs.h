// Programs with verbs ("glint-synth capture …"): each verb is a program of its own to RunProgram.
#pragma once

#include <cstdio>
#include <functional>
#include <string>
#include <vector>

#include "base/errors/errors.h"
#include "base/programs/program.h"

namespace glint {

struct Verb {
  std::string name;
  std::string description;
  std::string footer;  // examples
  // Gets the arguments from the verb on, so that argv[0] is the verb.
  std::function<int(int argc, char** argv, const ProgramInfo& info)> run;
};

// Runs the verb named by argv[1]; without one prints what there is. Returns the exit code.
inline int RunVerb(int argc, char** argv, const ProgramInfo& program,
                   const std::vector<Verb>& verbs) {
  const std::string wanted = argc > 1 ? argv[1] : "";
  for (const Verb& verb : verbs) {
    if (verb.name != wanted) continue;
    return verb.run(
        argc - 1, argv + 1,
        {program.name + " " + verb.name, verb.description, program.version, verb.footer});
  }
  if (wanted == "--version") {
    std::printf("%s %s\n", program.name.c_str(), program.version.c_str());
    return kExitDone;
  }
  if (wanted == kDescribeFlag) {
    Json list = Json::array();
    for (const Verb& verb : verbs) {
      list.push_back({{"verb", verb.name}, {"description", verb.description}});
    }
    const Json all = {{"program", program.name},
                      {"description", program.description},
                      {"version", program.version},
                      {"verbs", list}};
    std::printf("%s\n", all.dump(2).c_str());
    return kExitDone;
  }
  const bool asked = wanted == "--help" || wanted == "-h";
  FILE* out = asked ? stdout : stderr;
  if (!asked) {
    std::fprintf(out, "%s: error: %s\n\n", program.name.c_str(),
                 wanted.empty() ? "a verb is needed" : ("found no verb '" + wanted + "'").c_str());
  }
  std::fprintf(out, "%s\n\nUsage: %s VERB [OPTIONS]; for details, run %s VERB --help.\n\nVerbs:\n",
               program.description.c_str(), program.name.c_str(), program.name.c_str());
  for (const Verb& verb : verbs) {
    std::fprintf(out, "  %-10s %s\n", verb.name.c_str(), verb.description.c_str());
  }
  return asked ? kExitDone : kExitUser;
}

}  // namespace glint
