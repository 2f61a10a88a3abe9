// Changes of single values in a TOML file that a person also edits: comments, order and everything
// else stay as they are.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "base/files/json.h"

namespace glint {

// `text` with [table] key = value (text, number, flag, or list of these), or without the key where
// there is no value. Tables are made where they are missing. `file` is named in errors. Throws
// UserError: text that is no TOML, a table or key that is written in a way that a line's change
// cannot touch (inline tables, dotted keys), which a person must edit.
std::string WithTomlValue(const std::filesystem::path& file, const std::string& text,
                          const std::string& table, const std::string& key,
                          const std::optional<Json>& value);

// `text` with one more text in the list [table] key, which is made where it is missing; a single
// text becomes a list.
std::string WithTomlListItem(const std::filesystem::path& file, const std::string& text,
                             const std::string& table, const std::string& key,
                             const std::string& item);

// `text` with the table [table], empty where it is new, or without it and what is in it.
std::string WithTomlTable(const std::filesystem::path& file, const std::string& text,
                          const std::string& table, bool present);

// As TOML writes it. Throws UserError for null and objects.
std::string TomlText(const Json& value);

}  // namespace glint
