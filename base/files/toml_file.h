// Reading TOML with errors that name file, line, key and what stands there. Included by .cc files
// only.
#pragma once

#include <toml++/toml.h>
#include <filesystem>
#include <memory>
#include <string>

namespace glint {

// Where a value stands, for messages: "board.square_mm (line 12)".
struct TomlPlace {
  std::filesystem::path file;
  std::string key;
  std::string Field(const toml::node& node) const;
};

// Throws UserError: missing, unreadable, or a syntax error with its line and column.
std::unique_ptr<toml::table> ReadTomlFile(const std::filesystem::path& file);

// "the text \"abc\"", "a list", "the number 3" …
std::string DescribeToml(const toml::node& node);

}  // namespace glint
