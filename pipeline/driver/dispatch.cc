#include "pipeline/driver/dispatch.h"

#include <cstdio>
#include <filesystem>
#include <vector>

#include "base/errors/errors.h"
#include "pipeline/driver/child_process.h"
#include "pipeline/driver/programs.h"

namespace glint {
namespace {

int PrintHelp(std::FILE* stream, int code) {
  std::fputs(
      "Glint turns flash photographs of a flat material sample into relightable maps.\n\n"
      "Usage: glint VERB [ARGUMENTS]\n\nVerbs:\n",
      stream);
  for (const ProgramVerb& verb : ListVerbs()) {
    std::fprintf(stream, "  %-10s %s\n", verb.name.c_str(), verb.summary.c_str());
  }
  std::fputs(
      "\nFor details, run glint help VERB. A capture, step by step:\n"
      "  glint init wood        # after putting photographs into wood/photos\n"
      "  glint run wood         # all stages; a second run redoes only what has changed\n"
      "  glint status wood\n",
      stream);
  return code;
}

int UnknownVerb(const std::string& verb) {
  const std::string closest = ClosestVerb(verb, ListVerbs());
  const std::string remedy =
      closest.empty() ? "see glint --help" : "did you mean: glint " + closest;
  std::fprintf(stderr, "glint: error: unknown verb '%s'; %s\n", verb.c_str(), remedy.c_str());
  return kExitUser;
}

}  // namespace

int Dispatch(int argc, char** argv, const std::string& version) {
  std::vector<std::string> words(argv + 1, argv + argc);
  if (words.empty()) return PrintHelp(stderr, kExitUser);
  if (words[0] == "--version" || words[0] == "version") {
    std::printf("glint %s\n", version.c_str());
    return kExitDone;
  }
  if (words[0] == "--help" || words[0] == "-h" || (words[0] == "help" && words.size() == 1)) {
    return PrintHelp(stdout, kExitDone);
  }
  if (words[0] == "help") words = {words[1], "--help"};
  const bool plain = words[0].find('/') == std::string::npos && words[0][0] != '-';
  const std::filesystem::path program =
      plain ? FindProgram("glint-" + words[0]) : std::filesystem::path();
  if (program.empty()) return UnknownVerb(words[0]);
  words[0] = program;
  try {
    ReplaceProcess(words);
  } catch (const Error& error) {
    std::fprintf(stderr, "glint: error: %s\n", error.what());
    return error.code();
  }
}

}  // namespace glint
