#include "pipeline/studio/captures/toml_edit.h"

#include <toml++/toml.h>

#include <algorithm>
#include <sstream>
#include <vector>

#include "base/errors/errors.h"

namespace glint {
namespace {

toml::table Parsed(const std::filesystem::path& file, const std::string& text) {
  try {
    return toml::parse(text);
  } catch (const toml::parse_error& error) {
    std::ostringstream where;
    where << "line " << error.source().begin.line;
    throw UserError(file, where.str(), std::string(error.description()), "correct it in an editor");
  }
}

std::string Quoted(const std::string& text) {
  std::string quoted = "\"";
  for (const char c : text) {
    const auto code = static_cast<unsigned char>(c);
    if (c == '"' || c == '\\') {
      quoted += std::string("\\") + c;
    } else if (code < 0x20 || code == 0x7f) {
      char escape[8];
      std::snprintf(escape, sizeof escape, "\\u%04x", code);
      quoted += escape;
    } else {
      quoted += c;
    }
  }
  return quoted + "\"";
}

bool IsBareKey(const std::string& key) {
  return !key.empty() && key.find_first_not_of(
                             "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ"
                             "0123456789_-") == std::string::npos;
}

struct Lines {
  std::vector<std::string> all;  // without their ends
  std::string Joined() const {
    std::string text;
    for (const std::string& line : all) text += line + "\n";
    return text;
  }
};

Lines LinesOf(const std::string& text) {
  Lines lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) lines.all.push_back(line);
  return lines;
}

std::string Trimmed(const std::string& line) {
  const size_t first = line.find_first_not_of(" \t\r");
  if (first == std::string::npos) return "";
  return line.substr(first, line.find_last_not_of(" \t\r") - first + 1);
}

bool IsHeader(const std::string& line, const std::string& table) {
  const std::string text = Trimmed(line), header = "[" + table + "]";
  if (!text.starts_with(header)) return false;
  const std::string rest = Trimmed(text.substr(header.size()));
  return rest.empty() || rest[0] == '#';
}

// The line after which a new key of the table goes: its last that holds more than a remark.
size_t EndOfTable(const Lines& lines, size_t header) {
  size_t end = header;
  for (size_t i = header + 1; i < lines.all.size(); ++i) {
    const std::string text = Trimmed(lines.all[i]);
    if (text.starts_with("[")) break;
    if (!text.empty() && text[0] != '#') end = i;
  }
  return end;
}

// A key that Glint's own writer keeps as a remark, "# [fit]", is where a person looks for it.
void AddTable(const std::string& table, const std::string& line, Lines* lines) {
  for (size_t i = 0; i < lines->all.size(); ++i) {
    if (Trimmed(lines->all[i]) != "# [" + table + "]") continue;
    lines->all[i] = "[" + table + "]";
    lines->all.insert(lines->all.begin() + static_cast<std::ptrdiff_t>(i) + 1, line);
    return;
  }
  if (!lines->all.empty() && !Trimmed(lines->all.back()).empty()) lines->all.emplace_back();
  lines->all.push_back("[" + table + "]");
  lines->all.push_back(line);
}

// Everything but the one key is as it was.
bool OnlyDiffersIn(toml::table before, toml::table after, const std::string& table,
                   const std::string& key) {
  for (toml::table* document : {&before, &after}) {
    if (toml::table* inner = (*document)[table].as_table()) {
      inner->erase(key);
      if (inner->empty()) document->erase(table);
    }
  }
  return before == after;
}

}  // namespace

std::string TomlText(const Json& value) {
  if (value.is_string()) return Quoted(value.get<std::string>());
  if (value.is_boolean() || value.is_number()) return value.dump();
  if (value.is_array()) {
    std::string list;
    for (const Json& one : value) list += (list.empty() ? "" : ", ") + TomlText(one);
    return "[" + list + "]";
  }
  throw UserError("a value: found " + value.dump() + "; give a text, a number, a flag or a list");
}

std::string WithTomlValue(const std::filesystem::path& file, const std::string& text,
                          const std::string& table, const std::string& key,
                          const std::optional<Json>& value) {
  const toml::table before = Parsed(file, text);
  if (!IsBareKey(table) || !IsBareKey(key)) {
    throw UserError(file, table + "." + key, "a name with characters other than letters and digits",
                    "correct it in an editor");
  }
  const toml::node* old = before[table][key].node();
  if (old == nullptr && !value) return text;
  Lines lines = LinesOf(text);
  const std::string line = value ? key + " = " + TomlText(*value) : "";
  if (old != nullptr) {
    // From the key's line to the value's last; a remark behind the value stays.
    const size_t first = old->source().begin.line, last = old->source().end.line;
    if (first == 0 || last < first || last > lines.all.size()) {
      throw UserError(file, table + "." + key, "a value at no line", "change it in an editor");
    }
    const std::string& end_line = lines.all[last - 1];
    const std::string behind =
        end_line.substr(std::min<size_t>(end_line.size(), old->source().end.column - 1));
    const auto at = lines.all.begin() + static_cast<std::ptrdiff_t>(first) - 1;
    lines.all.erase(at, at + static_cast<std::ptrdiff_t>(last - first + 1));
    if (value)
      lines.all.insert(lines.all.begin() + static_cast<std::ptrdiff_t>(first) - 1, line + behind);
  } else {
    size_t header = 0;
    while (header < lines.all.size() && !IsHeader(lines.all[header], table)) ++header;
    if (header < lines.all.size()) {
      const size_t end = EndOfTable(lines, header);
      lines.all.insert(lines.all.begin() + static_cast<std::ptrdiff_t>(end) + 1, line);
    } else {
      AddTable(table, line, &lines);
    }
  }
  std::string changed = lines.Joined();
  bool good = false;
  try {
    const toml::table after = Parsed(file, changed);
    good = (after[table][key].node() != nullptr) == value.has_value() &&
           OnlyDiffersIn(before, after, table, key);
  } catch (const UserError&) {
  }
  if (!good) {
    throw UserError(file, table + "." + key, "it written in an unusual way",
                    "change it in an editor; Studio leaves the file as it is");
  }
  return changed;
}

std::string WithTomlTable(const std::filesystem::path& file, const std::string& text,
                          const std::string& table, bool present) {
  toml::table before = Parsed(file, text);
  if (before.contains(table) == present) return text;
  Lines lines = LinesOf(text);
  if (present) {
    if (!lines.all.empty() && !Trimmed(lines.all.back()).empty()) lines.all.emplace_back();
    lines.all.push_back("[" + table + "]");
  } else {
    size_t header = 0;
    while (header < lines.all.size() && !IsHeader(lines.all[header], table)) ++header;
    if (header < lines.all.size()) {
      const auto at = lines.all.begin() + static_cast<std::ptrdiff_t>(header);
      lines.all.erase(at, at + static_cast<std::ptrdiff_t>(EndOfTable(lines, header) - header + 1));
    }
  }
  std::string changed = lines.Joined();
  toml::table after = Parsed(file, changed);
  const bool good = after.contains(table) == present;
  before.erase(table);
  after.erase(table);
  if (!good || before != after) {
    throw UserError(file, table, "it written in an unusual way",
                    "change it in an editor; Studio leaves the file as it is");
  }
  return changed;
}

std::string WithTomlListItem(const std::filesystem::path& file, const std::string& text,
                             const std::string& table, const std::string& key,
                             const std::string& item) {
  const toml::table document = Parsed(file, text);
  Json list = Json::array();
  const toml::node_view<const toml::node> old = document[table][key];
  if (old.is_string()) list.push_back(**old.as_string());
  if (const toml::array* items = old.as_array()) {
    for (const toml::node& one : *items) {
      if (one.is_string()) list.push_back(one.as_string()->get());
    }
  }
  if (std::find(list.begin(), list.end(), Json(item)) != list.end()) return text;
  list.push_back(item);
  return WithTomlValue(file, text, table, key, list);
}

}  // namespace glint
