// The front end that all programs share: options, help, version, threads, seed, logging, --json,
// and errors turned into exit codes.
#pragma once

#include <cstdint>
#include <functional>
#include <string>

#include "base/files/json.h"
#include "base/programs/options.h"

namespace glint {

struct CommonOptions {
  int threads = 0;         // resolved: at least 1
  double memory_gb = 0;    // 0: a share of the machine's (memory_limit.h)
  std::uint64_t seed = 0;  // enters the manifest
  std::string log_level = "info";
  bool json = false;  // the result on stdout as JSON
  // For stages: compute although the result is up to date; or only say whether it is.
  bool force = false, check = false;
};

// The command line's side of them.
OptionSet CommonOptionSet(CommonOptions* common, bool keeps_results = true);

// What a program leaves on stdout: `text` for a person, or `json` with --json. A stage also sums up
// its result in a few words, which are all that `glint run` shows of it.
struct ProgramResult {
  std::string text;
  Json json;
  std::string summary = {};
};

// Alone on the command line: the program's description and options as JSON (OptionSet::Describe),
// for shells' completion and manual pages. Not in the help.
inline constexpr char kDescribeFlag[] = "--describe";

// Set by `glint run`: the stage prints one line, "fit  latent, 380 iterations  20.3 s".
inline constexpr char kOneLineVariable[] = "GLINT_ONE_LINE";

struct ProgramInfo {
  std::string name;         // "glint-calib"
  std::string description;  // first paragraph of --help
  std::string version;      // GLINT_VERSION
  std::string footer;       // examples, shown after the options
  // Whether its results may be up to date: it has --force and --status.
  bool keeps_results = true;
};

// Parses, runs `body`, prints its result, and returns the exit code. Messages go to stderr as
// "glint-calib: error: …".
int RunProgram(int argc, char** argv, const ProgramInfo& info, OptionSet* options,
               const std::function<ProgramResult(const CommonOptions&)>& body);

}  // namespace glint
