#include "pipeline/driver/completion.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <map>

#include "base/errors/errors.h"

namespace glint {
namespace {

// In single quotes, for a shell.
std::string ShellQuoted(const std::string& text) {
  std::string quoted = "'";
  for (const char c : text) quoted += c == '\'' ? "'\\''" : std::string(1, c);
  return quoted + "'";
}

std::string FirstSentence(const std::string& text) {
  const size_t end = text.find_first_of(";(");
  std::string first = text.substr(0, end);
  while (!first.empty() && first.back() == ' ') first.pop_back();
  return first;
}

Json AllOptions(const DescribedCommand& command) {
  Json options = command.options.is_array() ? command.options : Json::array();
  for (const Json& common : CommonOptionList()) options.push_back(common);
  return options;
}

std::vector<std::string> Flags(const DescribedCommand& command) {
  std::vector<std::string> flags;
  for (const Json& option : AllOptions(command)) {
    if (!option["positional"].get<bool>()) {
      flags.push_back("--" + option["name"].get<std::string>());
    }
  }
  return flags;
}

// The words that may follow "glint" ("") or "glint synth" ("synth").
std::map<std::string, std::vector<std::string>> VerbsAfter(
    const std::vector<DescribedCommand>& commands) {
  std::map<std::string, std::vector<std::string>> verbs;
  for (const DescribedCommand& command : commands) {
    verbs[command.words.size() > 1 ? command.words[0] : ""].push_back(command.words.back());
  }
  return verbs;
}

std::string Bash(const std::vector<DescribedCommand>& commands) {
  std::string words, flags, choices;
  for (const auto& [before, verbs] : VerbsAfter(commands)) {
    words += fmt::format("    {}) words={} ;;\n", ShellQuoted(before),
                         ShellQuoted(fmt::format("{}", fmt::join(verbs, " "))));
  }
  for (const DescribedCommand& command : commands) {
    const std::string name = fmt::format("{}", fmt::join(command.words, " "));
    flags += fmt::format("    {}) flags={} ;;\n", ShellQuoted(name),
                         ShellQuoted(fmt::format("{}", fmt::join(Flags(command), " "))));
    for (const Json& option : AllOptions(command)) {
      if (!option.contains("choices")) continue;
      choices += fmt::format(
          "    {}) choices={} ;;\n", ShellQuoted(name + " --" + option["name"].get<std::string>()),
          ShellQuoted(fmt::format(
              "{}", fmt::join(option["choices"].get<std::vector<std::string>>(), " "))));
    }
  }
  return "# bash completion for glint: glint completion bash writes it.\n"
         "_glint() {\n"
         "  local current=${COMP_WORDS[COMP_CWORD]} before=${COMP_WORDS[COMP_CWORD-1]}\n"
         "  local verb=${COMP_WORDS[1]} command=${COMP_WORDS[1]} words= flags= choices=\n"
         "  COMPREPLY=()\n"
         "  if ((COMP_CWORD == 1)); then verb=; fi\n"
         "  case $verb in\n" +
         words +
         "  esac\n"
         "  if ((COMP_CWORD == 1)) || { ((COMP_CWORD == 2)) && [[ -n $words ]]; }; then\n"
         "    COMPREPLY=($(compgen -W \"$words\" -- \"$current\"))\n"
         "    return\n"
         "  fi\n"
         "  if [[ -n $words ]]; then command=\"$verb ${COMP_WORDS[2]}\"; fi\n"
         "  case \"$command $before\" in\n" +
         choices +
         "  esac\n"
         "  if [[ -n $choices ]]; then\n"
         "    COMPREPLY=($(compgen -W \"$choices\" -- \"$current\"))\n"
         "    return\n"
         "  fi\n"
         "  if [[ $current == -* ]]; then\n"
         "    case $command in\n" +
         flags +
         "    esac\n"
         "    COMPREPLY=($(compgen -W \"$flags\" -- \"$current\"))\n"
         "    return\n"
         "  fi\n"
         "  compopt -o filenames\n"
         "  local IFS=$'\\n'\n"
         "  COMPREPLY=($(compgen -f -- \"$current\"))\n"
         "}\n"
         "complete -F _glint glint\n";
}

std::string Zsh(const std::vector<DescribedCommand>& commands) {
  const auto escaped = [](const std::string& text) {
    std::string out;
    for (const char c : text) {
      if (c == '[' || c == ']' || c == ':' || c == '\\') out += '\\';
      out += c;
    }
    return out;
  };
  std::string verbs, cases;
  for (const DescribedCommand& command : commands) {
    const std::string name = fmt::format("{}", fmt::join(command.words, " "));
    if (command.words.size() == 1) {
      verbs += "    " + ShellQuoted(name + ":" + FirstSentence(command.description)) + "\n";
    }
    std::string specs;
    for (const Json& option : AllOptions(command)) {
      if (option["positional"].get<bool>()) continue;
      std::string spec = "--" + option["name"].get<std::string>() + "[" +
                         escaped(FirstSentence(option["help"].get<std::string>())) + "]";
      if (option.contains("choices")) {
        spec +=
            ":value:(" +
            fmt::format("{}", fmt::join(option["choices"].get<std::vector<std::string>>(), " ")) +
            ")";
      } else if (option["kind"] != "flag") {
        spec += option["kind"] == "path" ? ":file:_files" : ":value:";
      }
      specs += " \\\n      " + ShellQuoted(spec);
    }
    cases +=
        "    " + ShellQuoted(name) + ") _arguments" + specs + " \\\n      '*:file:_files' ;;\n";
  }
  std::string inner;
  for (const auto& [before, words] : VerbsAfter(commands)) {
    if (before.empty()) continue;
    inner += fmt::format("    {}) inner=({}) ;;\n", ShellQuoted(before), fmt::join(words, " "));
  }
  return "#compdef glint\n"
         "# zsh completion for glint: glint completion zsh writes it.\n"
         "_glint() {\n"
         "  local -a verbs inner\n"
         "  verbs=(\n" +
         verbs +
         "  )\n"
         "  if ((CURRENT == 2)); then _describe 'verb' verbs; return; fi\n"
         "  local command=$words[2]\n"
         "  case $command in\n" +
         inner +
         "  esac\n"
         "  if (($#inner)); then\n"
         "    if ((CURRENT == 3)); then _describe 'verb' inner; return; fi\n"
         "    command=\"$command $words[3]\"\n"
         "    shift words; ((CURRENT--))\n"
         "  fi\n"
         "  shift words; ((CURRENT--))\n"
         "  case $command in\n" +
         cases +
         "  esac\n"
         "}\n"
         "if [[ $funcstack[1] == _glint ]]; then _glint \"$@\"; else compdef _glint glint; fi\n";
}

std::string Fish(const std::vector<DescribedCommand>& commands) {
  std::string out = "# fish completion for glint: glint completion fish writes it.\n";
  for (const DescribedCommand& command : commands) {
    const bool inner = command.words.size() > 1;
    const std::string here =
        inner ? fmt::format("__fish_seen_subcommand_from {}; and __fish_seen_subcommand_from {}",
                            command.words[0], command.words[1])
              : "__fish_seen_subcommand_from " + command.words[0];
    const std::string before =
        inner ? "__fish_seen_subcommand_from " + command.words[0] : "__fish_use_subcommand";
    out += fmt::format("complete -c glint {}-n {} -a {} -d {}\n", inner ? "" : "-f ",
                       ShellQuoted(before), command.words.back(),
                       ShellQuoted(FirstSentence(command.description)));
    for (const Json& option : AllOptions(command)) {
      if (option["positional"].get<bool>()) continue;
      std::string more;
      if (option.contains("choices")) {
        more = " -x -a " +
               ShellQuoted(fmt::format(
                   "{}", fmt::join(option["choices"].get<std::vector<std::string>>(), " ")));
      } else if (option["kind"] != "flag") {
        more = option["kind"] == "path" ? " -r -F" : " -x";
      }
      out += fmt::format("complete -c glint -n {} -l {}{} -d {}\n", ShellQuoted(here),
                         option["name"].get<std::string>(), more,
                         ShellQuoted(FirstSentence(option["help"].get<std::string>())));
    }
  }
  return out;
}

struct Shell {
  const char* name;
  std::string (*script)(const std::vector<DescribedCommand>& commands);
};
constexpr Shell kShells[] = {{"bash", Bash}, {"zsh", Zsh}, {"fish", Fish}};

}  // namespace

const std::vector<std::string>& CompletionShells() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> list;
    for (const Shell& shell : kShells) list.emplace_back(shell.name);
    return list;
  }();
  return names;
}

std::string CompletionScript(const std::string& shell,
                             const std::vector<DescribedCommand>& commands) {
  for (const Shell& known : kShells) {
    if (shell == known.name) return known.script(commands);
  }
  throw UserError(fmt::format("found the shell '{}'; use one of: {}", shell,
                              fmt::join(CompletionShells(), ", ")));
}

}  // namespace glint
