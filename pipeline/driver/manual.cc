#include "pipeline/driver/manual.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <sstream>

#include "base/files/files.h"

namespace glint {
namespace {

// Text as roff takes it: no line begins with a control character, no hyphen becomes a dash.
std::string Roff(const std::string& text) {
  std::string out;
  bool line_begins = true;
  for (const char c : text) {
    if (line_begins && (c == '.' || c == '\'')) out += "\\&";
    if (c == '\\') {
      out += "\\e";
    } else if (c == '-') {
      out += "\\-";
    } else {
      out += c;
    }
    line_begins = c == '\n';
  }
  return out;
}

std::string Head(const std::string& name, const std::string& version) {
  return fmt::format(".TH \"{}\" \"1\" \"\" \"Glint {}\" \"Glint\"\n", Roff(name), version);
}

std::string Section(const std::string& title, const std::string& text) {
  return ".SH " + title + "\n" + text + "\n";
}

std::string NameSection(const std::string& name, std::string description) {
  const size_t end = description.find_first_of(".:\n");
  return Section("NAME", Roff(name) + " \\- " + Roff(description.substr(0, end)));
}

std::string OptionEntry(const Json& option) {
  const auto name = option["name"].get<std::string>();
  const bool positional = option["positional"].get<bool>();
  std::string head = positional ? "\\fI" + Roff(name) + "\\fR" : "\\fB\\-\\-" + Roff(name) + "\\fR";
  if (option.contains("choices")) {
    head += " " + Roff(fmt::format(
                      "{}", fmt::join(option["choices"].get<std::vector<std::string>>(), "|")));
  } else if (!positional && option["kind"] != "flag") {
    std::string kind = option["kind"];
    std::transform(kind.begin(), kind.end(), kind.begin(),
                   [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
    head += " \\fI" + kind + "\\fR";
  }
  std::string text = option["help"];
  std::vector<std::string> limits;
  if (option.contains("low")) {
    limits.push_back(
        fmt::format("{} to {}", option["low"].get<double>(), option["high"].get<double>()));
  }
  if (option.contains("default") && !positional) {
    limits.push_back("default: " + option["default"].get<std::string>());
  }
  if (!limits.empty()) text += fmt::format(" ({})", fmt::join(limits, "; "));
  return ".TP\n" + head + "\n" + Roff(text) + "\n";
}

std::string OptionEntries(const Json& options) {
  std::string text;
  if (!options.is_array()) return text;
  for (const Json& option : options) text += OptionEntry(option);
  return text;
}

std::string Synopsis(const DescribedCommand& command) {
  std::string text =
      fmt::format("\\fBglint {}\\fR", Roff(fmt::format("{}", fmt::join(command.words, " "))));
  if (!command.options.is_array()) return text + " \\fIVERB\\fR [\\fIOPTIONS\\fR]";
  text += " [\\fIOPTIONS\\fR]";
  for (const Json& option : command.options) {
    if (option["positional"].get<bool>()) {
      text += " [\\fI" + Roff(option["name"].get<std::string>()) + "\\fR]";
    }
  }
  return text;
}

// Examples keep their lines.
std::string Examples(const std::string& footer) {
  return footer.empty() ? "" : Section("EXAMPLES", ".nf\n" + Roff(footer) + "\n.fi");
}

}  // namespace

std::string ManualPage(const DescribedCommand& command,
                       const std::vector<DescribedCommand>& verbs_within,
                       const std::string& version) {
  const std::string name = "glint-" + command.words[0];
  std::string text = Head(name, version) + NameSection(name, command.description) +
                     Section("SYNOPSIS", Synopsis(command)) +
                     Section("DESCRIPTION", Roff(command.description));
  if (const std::string own = OptionEntries(command.options); !own.empty()) {
    text += Section("OPTIONS", own);
  }
  for (const DescribedCommand& verb : verbs_within) {
    std::string title = fmt::format("{}", fmt::join(verb.words, " "));
    std::transform(title.begin(), title.end(), title.begin(),
                   [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
    text += Section("\"" + Roff(title) + "\"",
                    Synopsis(verb) + "\n.PP\n" + Roff(verb.description) + "\n" +
                        OptionEntries(verb.options) +
                        (verb.footer.empty() ? "" : ".PP\n.nf\n" + Roff(verb.footer) + "\n.fi"));
  }
  return text + Section("COMMON OPTIONS", OptionEntries(CommonOptionList())) +
         Examples(command.footer) + Section("SEE ALSO", ".BR glint (1)");
}

std::string OverviewPage(const std::vector<DescribedCommand>& commands,
                         const std::string& version) {
  std::string verbs, pages;
  for (const DescribedCommand& command : commands) {
    if (command.words.size() > 1) continue;
    verbs += ".TP\n\\fB" + Roff(command.words[0]) + "\\fR\n" + Roff(command.description) + "\n";
    pages +=
        std::string(pages.empty() ? "" : " ,\n") + ".BR glint\\-" + Roff(command.words[0]) + " (1)";
  }
  return Head("glint", version) +
         NameSection("glint",
                     "turn flash photographs of a flat material sample into relightable maps") +
         Section("SYNOPSIS", "\\fBglint\\fR \\fIVERB\\fR [\\fIARGUMENTS\\fR]") +
         Section("VERBS", verbs) +
         Section("EXAMPLES",
                 ".nf\n" + Roff("glint init wood\nglint run wood\nglint view wood") + "\n.fi") +
         Section("SEE ALSO", pages);
}

std::vector<std::filesystem::path> WriteManual(const std::filesystem::path& folder,
                                               const std::vector<DescribedCommand>& commands,
                                               const std::string& version) {
  std::filesystem::create_directories(folder);
  std::vector<std::filesystem::path> files{folder / "glint.1"};
  WriteFileAtomically(files[0], OverviewPage(commands, version));
  for (const DescribedCommand& command : commands) {
    if (command.words.size() > 1) continue;
    std::vector<DescribedCommand> within;
    for (const DescribedCommand& other : commands) {
      if (other.words.size() > 1 && other.words[0] == command.words[0]) within.push_back(other);
    }
    files.push_back(folder / ("glint-" + command.words[0] + ".1"));
    WriteFileAtomically(files.back(), ManualPage(command, within, version));
  }
  return files;
}

}  // namespace glint
