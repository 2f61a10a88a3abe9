// One table of a TOML file that a person wrote, read key by key: what is wrong is said with file,
// line, key, what stands there and the remedy; what is not asked for is unknown in the end.
// Included by .cc files only.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "base/files/toml_file.h"

namespace glint {

// All throw UserError where a value is not what is asked for.
class TomlTable {
 public:
  // The table `name` of the document, which must outlive this; it may be absent.
  TomlTable(const std::filesystem::path& file, const toml::table& document, std::string name);

  bool present() const { return table_ != nullptr; }
  const std::string& name() const { return name_; }
  // The key's value, for what has no reader below; null: absent.
  const toml::node* Find(const std::string& key);
  [[noreturn]] void Reject(const toml::node& node, const std::string& key,
                           const std::string& remedy) const;
  [[noreturn]] void Missing(const std::string& key, const std::string& remedy) const;

  // From `low` to `high`. `unit` ends the remedy: " of millimetres, greater than 0".
  double Number(const std::string& key, double fallback, double low, double high,
                const std::string& unit);
  // One of `choices`, where there are any.
  std::string Text(const std::string& key, const std::string& fallback,
                   const std::vector<std::string>& choices = {});
  // A list of `count` numbers (or one number repeated, where `one_for_all`); empty: absent.
  std::vector<double> Numbers(const std::string& key, size_t count, bool one_for_all,
                              const std::string& remedy);
  // `count` points, as [[x, y], …] (one: [x, y]), one after the other; empty: absent.
  std::vector<double> Points(const std::string& key, size_t count, const std::string& remedy);
  std::vector<int> Integers(const std::string& key, size_t count, bool one_for_all,
                            const std::string& remedy);
  // A list of texts, or one text.
  std::vector<std::string> Texts(const std::string& key, const std::string& remedy);
  bool Flag(const std::string& key, bool fallback);
  // Throws on the first key that nobody asked for.
  void RejectUnknown() const;

 private:
  std::filesystem::path file_;
  std::string name_;
  const toml::table* table_ = nullptr;
  std::vector<std::string> known_;
};

}  // namespace glint
