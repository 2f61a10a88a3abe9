// Options registered once: from one declaration come the command line, the table in capture.toml,
// the echo in the manifest and the help text.
//
//   struct RefineOptions { int iterations = 50; … };
//   options.Add("iterations", &o.iterations, "maximum number of solver steps");
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <variant>
#include <vector>

#include "base/files/json.h"

namespace CLI {
class App;
}

namespace glint {

// Whether a change of the option makes earlier results stale. Options that cannot change a result
// (threads, verbosity) are kept out of the manifest and go to run.json.
enum class Invalidates { kYes, kNo };

// Names of the options that `glint run` gives a stage by itself, with commas between.
inline constexpr char kRunOptionsVariable[] = "GLINT_RUN_OPTIONS";

class OptionSet {
 public:
  using Target =
      std::variant<bool*, int*, std::uint64_t*, double*, std::string*, std::filesystem::path*,
                   std::vector<std::string>*, std::vector<double>*>;

  // Names are kebab-case on the command line and in capture.toml ("max-iterations").
  void Add(const std::string& name, Target target, const std::string& help,
           Invalidates invalidates = Invalidates::kYes);
  // A string option restricted to `choices`.
  void AddChoice(const std::string& name, std::string* target, std::vector<std::string> choices,
                 const std::string& help, Invalidates invalidates = Invalidates::kYes);
  // A number restricted to [low, high].
  void AddRange(const std::string& name, Target target, double low, double high,
                const std::string& help, Invalidates invalidates = Invalidates::kYes);
  // A positional argument of the command line only (never in capture.toml or the manifest).
  void AddPositional(const std::string& name, Target target, const std::string& help,
                     bool required);

  // Reads the table [table] of a capture.toml into the targets that the command line did not set.
  // Unknown keys, wrong types and values out of range throw UserError naming file and key.
  void LoadToml(const std::filesystem::path& file, const std::string& table);

  // `group`: the title under which the help lists them.
  void Register(CLI::App* app, const std::string& group = "Options");

  // For shells' completion and manual pages: a list of {name, help, kind, default?, choices?,
  // low?, high?, positional}; kinds are "flag", "integer", "number", "text", "path", "texts" and
  // "numbers".
  Json Describe() const;

  Json ManifestEcho() const;  // every invalidating option with its resolved value
  Json RunEcho() const;       // the others

  // The invalidating options that a person gave on the command line, each with the word that gives
  // it again: {"light": "--light=camera"}. Those that `glint run` gave by itself are not among
  // them.
  Json CommandLineEcho() const;

 private:
  struct Option {
    std::string name;
    Target target;
    std::string help;
    Invalidates invalidates;
    std::vector<std::string> choices;
    double low = 0, high = 0;
    bool has_range = false;
    bool positional = false, required = false;
    std::function<bool()> set_on_command_line;
  };
  Json Echo(Invalidates which) const;
  std::vector<Option> options_;
};

}  // namespace glint
