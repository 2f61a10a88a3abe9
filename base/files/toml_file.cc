#include "base/files/toml_file.h"

#include <sstream>
#include <string_view>

#include "base/errors/errors.h"
#include "base/files/files.h"

namespace glint {
namespace {

constexpr std::size_t kMaxTomlBytes = 1u << 20;

// What editors and habits do to a file, which the parser's words do not name.
std::string RemedyFor(std::string_view text) {
  using namespace std::string_view_literals;
  if (text.starts_with("\xFF\xFE"sv) || text.starts_with("\xFE\xFF"sv)) {
    return "the file is in UTF-16: save it as UTF-8";
  }
  for (const std::string_view quote : {"\u201C"sv, "\u201D"sv, "\u201E"sv, "\u00AB"sv}) {
    if (text.find(quote) != std::string_view::npos) {
      return "it has typographic quotes, such as " + std::string(quote) +
             ", which a word processor makes: write plain ones (\")";
    }
  }
  return "write TOML in UTF-8, with decimal points, for example: size_mm = [100.5, 100]";
}

}  // namespace

std::string TomlPlace::Field(const toml::node& node) const {
  const auto line = node.source().begin.line;
  return line > 0 ? key + " (line " + std::to_string(line) + ")" : key;
}

std::unique_ptr<toml::table> ReadTomlFile(const std::filesystem::path& file) {
  const std::string text = ReadTextFile(file, kMaxTomlBytes);
  try {
    return std::make_unique<toml::table>(toml::parse(text, file.string()));
  } catch (const toml::parse_error& error) {
    const auto where = error.source().begin;
    const std::string remedy = RemedyFor(text);
    throw UserError(
        file, "line " + std::to_string(where.line) + ", column " + std::to_string(where.column),
        "a syntax error (" + std::string(error.description()) + ")", remedy);
  }
}

std::string DescribeToml(const toml::node& node) {
  std::ostringstream text;
  switch (node.type()) {
    case toml::node_type::string:
      text << "the text '" << node.as_string()->get() << "'";
      break;
    case toml::node_type::integer:
      text << "the number " << node.as_integer()->get();
      break;
    case toml::node_type::floating_point:
      text << "the number " << node.as_floating_point()->get();
      break;
    case toml::node_type::boolean:
      text << (node.as_boolean()->get() ? "true" : "false");
      break;
    case toml::node_type::array:
      text << "a list of " << node.as_array()->size();
      break;
    case toml::node_type::table:
      text << "a table";
      break;
    default:
      text << "a date or time";
  }
  return text.str();
}

}  // namespace glint
