#include "pipeline/driver/ninja_file.h"

#include <fstream>
#include <set>

#include "base/errors/errors.h"
#include "base/files/hash.h"
#include "pipeline/driver/edge.h"

namespace glint {
namespace {

constexpr char kChoicesPrefix[] = "# choices: ";

void RequireOneLine(const std::string& text) {
  if (text.find_first_of("\n\r") == std::string::npos) return;
  throw UserError("'" + text + "': found a line break in a file's name; rename the file");
}

// A path in a build line.
std::string EscapedPath(const std::string& path) {
  RequireOneLine(path);
  if (path.find('|') != std::string::npos) {
    throw UserError("'" + path + "': found a '|' in a file's name; rename the file");
  }
  std::string text;
  for (const char c : path) {
    if (c == '$' || c == ' ' || c == ':') text += '$';
    text += c;
  }
  return text;
}

// A word of a shell command in a variable's value.
std::string EscapedWord(const std::string& word) {
  RequireOneLine(word);
  std::string quoted = "'";
  for (const char c : word) {
    if (c == '\'') {
      quoted += "'\\''";
    } else {
      quoted += c == '$' ? "$$" : std::string(1, c);
    }
  }
  quoted += "'";
  return word.find_first_not_of(
             "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789"
             "_-./,=+") == std::string::npos &&
                 !word.empty()
             ? word
             : quoted;
}

std::string EdgeText(const NinjaEdge& edge) {
  const StageStep& step = edge.step;
  std::string inputs;
  std::set<std::string> seen;
  std::string text = "build " + EscapedPath(step.manifest) + ": stage";
  for (const std::string& input : step.inputs) {
    inputs += input + "\n";
    if (seen.insert(input).second) text += " $\n    " + EscapedPath(input);
  }
  text += " | " + EscapedPath(edge.program.string());
  for (const std::string& input : edge.more_inputs) {
    if (seen.insert(input).second) text += " $\n    " + EscapedPath(input);
  }
  if (edge.always) text += " always";
  text += "\n  program = " + EscapedWord(edge.program.string());
  text += "\n  arguments =";
  for (const std::string& argument : step.arguments) text += " " + EscapedWord(argument);
  if (!step.kept.empty()) text += " " + std::string(kKeptFlag);
  for (const std::string& argument : step.kept) text += " " + EscapedWord(argument);
  // Ninja does not see that an input is gone or has another content; that the command has changed
  // it does.
  text += "\n  inputs = " + HashBytes(inputs + edge.content);
  text += "\n  stage = " + step.stage + "\n\n";
  return text;
}

}  // namespace

std::string NinjaText(const std::vector<NinjaEdge>& edges, const std::filesystem::path& runner,
                      const RunChoices& choices) {
  std::string text =
      "# Written by glint run; the next run rewrites it. By hand, in the capture's folder:\n"
      "#   ninja -f glint/build.ninja\n";
  text += kChoicesPrefix + ToJson(choices).dump() + "\n";
  text += "ninja_required_version = 1.5\nbuilddir = glint\n\n";
  // A stage that finds its result up to date leaves the manifest alone: with restat, later stages
  // then do not run.
  text += "rule stage\n  command = exec " + EscapedWord(runner.string()) +
          " --edge $stage $program $arguments # reads $inputs\n"
          "  description = $stage\n  restat = 1\n  pool = console\n\n";
  text += "build always: phony\n\n";
  for (const NinjaEdge& edge : edges) text += EdgeText(edge);
  return text;
}

RunChoices ReadChoices(const std::filesystem::path& ninja_file) {
  std::ifstream stream(ninja_file);
  for (std::string line; std::getline(stream, line);) {
    if (line.rfind(kChoicesPrefix, 0) != 0) continue;
    try {
      return RunChoicesFromJson(Json::parse(line.substr(sizeof(kChoicesPrefix) - 1)));
    } catch (const nlohmann::json::exception&) {
      return {};
    }
  }
  return {};
}

}  // namespace glint
