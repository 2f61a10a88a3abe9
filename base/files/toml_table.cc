#include "base/files/toml_table.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "base/errors/errors.h"

namespace glint {

TomlTable::TomlTable(const std::filesystem::path& file, const toml::table& document,
                     std::string name)
    : file_(file), name_(std::move(name)) {
  const toml::node* node = document.get(name_);
  if (node == nullptr) return;
  if (!node->is_table()) {
    throw UserError(file_, name_, DescribeToml(*node), "write a table: [" + name_ + "]");
  }
  table_ = node->as_table();
}

const toml::node* TomlTable::Find(const std::string& key) {
  known_.push_back(key);
  return table_ == nullptr ? nullptr : table_->get(key);
}

void TomlTable::Reject(const toml::node& node, const std::string& key,
                       const std::string& remedy) const {
  throw UserError(file_, TomlPlace{file_, name_ + "." + key}.Field(node), DescribeToml(node),
                  remedy);
}

void TomlTable::Missing(const std::string& key, const std::string& remedy) const {
  throw UserError(file_, name_ + "." + key, "no such key", remedy);
}

double TomlTable::Number(const std::string& key, double fallback, double low, double high,
                         const std::string& unit) {
  const toml::node* node = Find(key);
  if (node == nullptr) return fallback;
  const auto value = node->is_number() ? node->value<double>() : std::nullopt;
  if (!value || !(*value >= low && *value <= high)) Reject(*node, key, "give a number" + unit);
  return *value;
}

std::string TomlTable::Text(const std::string& key, const std::string& fallback,
                            const std::vector<std::string>& choices) {
  const toml::node* node = Find(key);
  if (node == nullptr) return fallback;
  std::string list;
  for (const std::string& choice : choices) list += (list.empty() ? "" : ", ") + choice;
  if (!node->is_string())
    Reject(*node, key, list.empty() ? "give text in quotes" : "use one of: " + list);
  std::string text = node->as_string()->get();
  if (!choices.empty() && std::find(choices.begin(), choices.end(), text) == choices.end()) {
    Reject(*node, key, "use one of: " + list);
  }
  return text;
}

std::vector<double> TomlTable::Numbers(const std::string& key, size_t count, bool one_for_all,
                                       const std::string& remedy) {
  const toml::node* node = Find(key);
  if (node == nullptr) return {};
  if (one_for_all && node->is_number()) return std::vector<double>(count, *node->value<double>());
  const toml::array* array = node->as_array();
  if (array == nullptr || array->size() != count) Reject(*node, key, remedy);
  std::vector<double> numbers;
  for (const toml::node& element : *array) {
    const auto value = element.is_number() ? element.value<double>() : std::nullopt;
    if (!value || !std::isfinite(*value)) Reject(element, key, remedy);
    numbers.push_back(*value);
  }
  return numbers;
}

std::vector<double> TomlTable::Points(const std::string& key, size_t count,
                                      const std::string& remedy) {
  const toml::node* node = Find(key);
  if (node == nullptr) return {};
  std::vector<double> numbers;
  const auto add = [&](const toml::node& point) {
    const toml::array* pair = point.as_array();
    if (pair == nullptr || pair->size() != 2) Reject(point, key, remedy);
    for (const toml::node& element : *pair) {
      const auto value = element.is_number() ? element.value<double>() : std::nullopt;
      if (!value || !std::isfinite(*value)) Reject(element, key, remedy);
      numbers.push_back(*value);
    }
  };
  if (count == 1) {
    add(*node);
    return numbers;
  }
  const toml::array* array = node->as_array();
  if (array == nullptr || array->size() != count) Reject(*node, key, remedy);
  for (const toml::node& point : *array) add(point);
  return numbers;
}

std::vector<int> TomlTable::Integers(const std::string& key, size_t count, bool one_for_all,
                                     const std::string& remedy) {
  const std::vector<double> numbers = Numbers(key, count, one_for_all, remedy);
  std::vector<int> integers;
  for (const double number : numbers) {
    if (number != std::floor(number) || std::abs(number) > 1e9)
      Reject(*table_->get(key), key, remedy);
    integers.push_back(static_cast<int>(number));
  }
  return integers;
}

std::vector<std::string> TomlTable::Texts(const std::string& key, const std::string& remedy) {
  const toml::node* node = Find(key);
  if (node == nullptr) return {};
  if (node->is_string()) return {node->as_string()->get()};
  const toml::array* array = node->as_array();
  if (array == nullptr) Reject(*node, key, remedy);
  std::vector<std::string> texts;
  for (const toml::node& element : *array) {
    if (!element.is_string()) Reject(element, key, remedy);
    texts.push_back(element.as_string()->get());
  }
  return texts;
}

bool TomlTable::Flag(const std::string& key, bool fallback) {
  const toml::node* node = Find(key);
  if (node == nullptr) return fallback;
  if (!node->is_boolean()) Reject(*node, key, "give true or false");
  return node->as_boolean()->get();
}

void TomlTable::RejectUnknown() const {
  if (table_ == nullptr) return;
  for (const auto& [key, node] : *table_) {
    if (std::find(known_.begin(), known_.end(), key.str()) != known_.end()) continue;
    std::string list;
    for (const std::string& name : known_) list += (list.empty() ? "" : ", ") + name;
    throw UserError(file_, TomlPlace{file_, name_ + "." + std::string(key.str())}.Field(node),
                    "an unknown key", "use one of: " + list);
  }
}

}  // namespace glint
