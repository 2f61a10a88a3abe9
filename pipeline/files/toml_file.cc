#include "pipeline/files/toml_file.h"

#include <sstream>

#include "base/errors/errors.h"
#include "pipeline/files/files.h"

namespace glint {
namespace {
constexpr std::size_t kMaxTomlBytes = 1u << 20;
}

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
    throw UserError(
        file, "line " + std::to_string(where.line) + ", column " + std::to_string(where.column),
        "a syntax error (" + std::string(error.description()) + ")",
        "write TOML, for example: size_mm = [100, 100]");
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
