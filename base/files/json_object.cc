#include "base/files/json_object.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/errors/errors.h"

namespace glint {

std::string Describe(const Json& value) {
  // Strings in JSON are UTF-8 that the parser has checked.
  const std::string text = value.dump(-1, ' ', true);
  return text.size() <= 60 ? text : text.substr(0, 57) + "...";
}

JsonObject::JsonObject(std::filesystem::path file, std::string name, const Json& json)
    : file_(std::move(file)), name_(std::move(name)), json_(json) {
  if (!json_.is_object()) throw UserError(file_, name_, Describe(json_), "write an object: {…}");
}

std::string JsonObject::Field(const std::string& key) const {
  return name_.empty() ? key : name_ + "." + key;
}

bool JsonObject::Has(const std::string& key) const {
  known_.push_back(key);
  return json_.contains(key);
}

const Json& JsonObject::Find(const std::string& key, const std::string& remedy) {
  known_.push_back(key);
  const auto found = json_.find(key);
  if (found == json_.end()) throw UserError(file_, Field(key), "no such field", remedy);
  return *found;
}

void JsonObject::Reject(const std::string& key, const std::string& remedy) const {
  throw UserError(file_, Field(key), Describe(json_.at(key)), remedy);
}

double JsonObject::Number(const std::string& key, double low, double high,
                          const std::string& remedy) {
  const Json& value = Find(key, remedy);
  if (!value.is_number()) Reject(key, remedy);
  const double number = value.get<double>();
  if (!(number >= low && number <= high)) Reject(key, remedy);
  return number;
}

int JsonObject::Integer(const std::string& key, const std::string& remedy) {
  const double number = Number(key, -1e9, 1e9, remedy);
  if (number != std::floor(number)) Reject(key, remedy);
  return static_cast<int>(number);
}

bool JsonObject::Flag(const std::string& key) {
  const Json& value = Find(key, "give true or false");
  if (!value.is_boolean()) Reject(key, "give true or false");
  return value.get<bool>();
}

std::string JsonObject::Text(const std::string& key, const std::string& remedy) {
  const Json& value = Find(key, remedy);
  if (!value.is_string()) Reject(key, remedy);
  return value.get<std::string>();
}

const Json& JsonObject::Array(const std::string& key, size_t count, const std::string& remedy) {
  const Json& value = Find(key, remedy);
  if (!value.is_array() || (count > 0 && value.size() != count)) Reject(key, remedy);
  return value;
}

std::vector<double> JsonObject::Numbers(const std::string& key, size_t count,
                                        const std::string& remedy) {
  std::vector<double> numbers;
  for (const Json& element : Array(key, count, remedy)) {
    if (!element.is_number()) Reject(key, remedy);
    numbers.push_back(element.get<double>());
    if (!std::isfinite(numbers.back())) Reject(key, remedy);
  }
  return numbers;
}

std::vector<int> JsonObject::Integers(const std::string& key, size_t count,
                                      const std::string& remedy) {
  std::vector<int> integers;
  for (const double number : Numbers(key, count, remedy)) {
    if (number != std::floor(number) || std::abs(number) > 1e9) Reject(key, remedy);
    integers.push_back(static_cast<int>(number));
  }
  return integers;
}

JsonObject JsonObject::Member(const std::string& key) {
  return {file_, Field(key), Find(key, "write an object: {…}")};
}

JsonObject JsonObject::Element(const std::string& key, size_t index) {
  return {file_, Field(key) + "[" + std::to_string(index) + "]",
          Find(key, "write a list").at(index)};
}

void JsonObject::RejectUnknown() const {
  for (const auto& [key, value] : json_.items()) {
    if (std::find(known_.begin(), known_.end(), key) != known_.end()) continue;
    std::string list;
    for (const std::string& name : known_) {
      if (list.find(name) == std::string::npos) list += (list.empty() ? "" : ", ") + name;
    }
    throw UserError(file_, Field(key), "an unknown field", "use one of: " + list);
  }
}

}  // namespace glint
