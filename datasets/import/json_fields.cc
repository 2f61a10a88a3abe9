#include "datasets/import/json_fields.h"

#include <cmath>
#include <utility>

#include "base/errors/errors.h"

namespace glint {

std::string ShownJson(const Json& value) {
  std::string text = value.dump(-1, ' ', false, Json::error_handler_t::replace);
  if (text.size() > 60) text = text.substr(0, 57) + "...";
  return text;
}

JsonFields::JsonFields(const std::filesystem::path& file, const Json& json, std::string name)
    : file_(file), json_(json), name_(std::move(name)) {
  if (!json_.is_object()) Reject(name_, json_, "an object in braces is expected");
}

const Json* JsonFields::Find(const std::string& field) {
  known_.insert(field);
  const auto found = json_.find(field);
  return found == json_.end() ? nullptr : &*found;
}

const Json& JsonFields::Require(const std::string& field, const std::string& remedy) {
  const Json* found = Find(field);
  if (found == nullptr) throw UserError(file_, Path(field), "no such field", remedy);
  return *found;
}

std::string JsonFields::Text(const std::string& field, const std::string& fallback) {
  const Json* found = Find(field);
  if (found == nullptr) return fallback;
  if (!found->is_string()) Reject(Path(field), *found, "text in quotes is expected");
  return found->get<std::string>();
}

std::vector<double> JsonFields::Numbers(const std::string& field, const Json& value, size_t count,
                                        bool one_for_all, double low) const {
  const std::string remedy = std::string(one_for_all ? "a number or " : "") + "a list of " +
                             std::to_string(count) + " numbers is expected" +
                             (low == 0 ? ", none below 0" : "");
  std::vector<double> numbers;
  if ((one_for_all || count == 1) && value.is_number()) {
    numbers.assign(count, value.get<double>());
  } else {
    if (!value.is_array() || value.size() != count) Reject(Path(field), value, remedy);
    for (const Json& element : value) {
      if (!element.is_number()) Reject(Path(field), value, remedy);
      numbers.push_back(element.get<double>());
    }
  }
  for (const double number : numbers) {
    if (!(std::abs(number) < -kAny) || number < low) Reject(Path(field), value, remedy);
  }
  return numbers;
}

std::string JsonFields::Path(const std::string& field) const {
  return name_.empty() ? field : name_ + "." + field;
}

void JsonFields::Reject(const std::string& path, const Json& value,
                        const std::string& remedy) const {
  throw UserError(file_, path, ShownJson(value), remedy);
}

void JsonFields::RejectUnknown() const {
  for (const auto& [key, value] : json_.items()) {
    if (known_.count(key) > 0) continue;
    std::string list;
    for (const std::string& name : known_) list += (list.empty() ? "" : ", ") + name;
    throw UserError(file_, Path(key), "an unknown field", "use one of: " + list);
  }
}

}  // namespace glint
