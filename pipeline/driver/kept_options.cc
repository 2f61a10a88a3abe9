#include "pipeline/driver/kept_options.h"

#include <fmt/format.h>
#include <toml++/toml.h>

#include <algorithm>
#include <fstream>

#include "base/files/json.h"
#include "base/files/toml_file.h"

namespace glint {
namespace {

// {"light": "--light=camera"}, as the stage has written it; empty where nothing was chosen.
Json GivenOnCommandLine(const Capture& capture, const StageStep& step) {
  std::ifstream stream((capture.folder / step.manifest).parent_path() / "run.json");
  const Json facts = Json::parse(stream, nullptr, false);
  if (!facts.is_object() || !facts.contains("command_line")) return Json::object();
  const Json& given = facts["command_line"];
  return given.is_object() ? given : Json::object();
}

bool IsChosenByRun(const StageStep& step, const std::string& name) {
  return std::find(step.arguments.begin(), step.arguments.end(), "--" + name) !=
         step.arguments.end();
}

// The word that gives the option the value that capture.toml has for it; empty for lists.
std::string WordOfToml(const std::string& name, const toml::node& value) {
  if (value.is_boolean()) return value.as_boolean()->get() ? "--" + name : "--no-" + name;
  if (value.is_string()) return fmt::format("--{}={}", name, value.as_string()->get());
  if (value.is_integer()) return fmt::format("--{}={}", name, value.as_integer()->get());
  if (value.is_floating_point()) {
    return fmt::format("--{}={}", name, value.as_floating_point()->get());
  }
  return "";
}

}  // namespace

std::vector<std::string> KeepOptions(const Capture& capture, std::vector<StageStep>* steps) {
  std::vector<std::string> notes;
  const auto document = ReadTomlFile(capture.file);
  for (StageStep& step : *steps) {
    const toml::table* table = (*document)[step.stage].as_table();
    const Json options = GivenOnCommandLine(capture, step);
    for (const auto& [name, given] : options.items()) {
      if (!given.is_string() || IsChosenByRun(step, name)) continue;
      const auto word = given.get<std::string>();
      const toml::node* in_file = table == nullptr ? nullptr : table->get(name);
      if (in_file == nullptr) {
        step.kept.push_back(word);
        notes.push_back(
            fmt::format("{0} keeps {1}, which was given on its command line; glint {0} without it, "
                        "or [{0}] {2} "
                        "in {3}, undoes that",
                        step.stage, word, name, capture.file.filename().string()));
      } else if (WordOfToml(name, *in_file) != word) {
        notes.push_back(
            fmt::format("{0}: [{0}] {1} in {2} overrides {3}, which was given on the command line",
                        step.stage, name, capture.file.filename().string(), word));
      }
    }
  }
  return notes;
}

}  // namespace glint
