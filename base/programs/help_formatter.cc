#include "base/programs/help_formatter.h"

#include <sstream>

namespace glint {
namespace {

constexpr size_t kColumns = 80;
constexpr char kIndent[] = "        ";

// "--views", "-v, --verbose". That --no-verbose is known too is of use beside capture.toml only.
std::string NamesOf(const CLI::Option& option, bool positional) {
  if (positional) return option.get_name(true, false);
  std::string names;
  for (const std::string& name : option.get_snames()) names += "-" + name + ", ";
  const std::string name = option.get_lnames().empty() ? "" : option.get_lnames()[0];
  return names + "--" + name;
}

}  // namespace

std::string Wrapped(const std::string& text, const std::string& indent, size_t width) {
  std::istringstream words(text);
  std::string out, line = indent;
  for (std::string word; words >> word;) {
    if (line.size() > indent.size() && line.size() + 1 + word.size() > width) {
      out += line + "\n";
      line = indent;
    }
    line += (line.size() > indent.size() ? " " : "") + word;
  }
  return line.size() > indent.size() ? out + line + "\n" : out;
}

std::string HelpFormatter::make_option(const CLI::Option* option, bool positional) const {
  std::string head = "  " + NamesOf(*option, positional);
  if (!option->get_option_text().empty()) head += " " + option->get_option_text();
  if (option->get_required()) head += " (required)";
  return head + "\n" + Wrapped(option->get_description(), kIndent, kColumns);
}

}  // namespace glint
