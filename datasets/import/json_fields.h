// Reading JSON that other people wrote, with errors that name file and field.
#pragma once

#include <filesystem>
#include <set>
#include <string>
#include <vector>

#include "base/files/json_file.h"

namespace glint {

// The value's text, shortened.
std::string ShownJson(const Json& value);

// An object of a file; keeps book of the fields that were asked for. `file` and `json` must outlive
// it.
class JsonFields {
 public:
  static constexpr double kAny = -1e30;  // no lower bound

  // `name` is the object's path in the file, empty at the top. Throws UserError when it is no
  // object.
  JsonFields(const std::filesystem::path& file, const Json& json, std::string name);

  const Json* Find(const std::string& field);  // nullptr: absent
  const Json& Require(const std::string& field, const std::string& remedy);
  std::string Text(const std::string& field, const std::string& fallback);

  // `count` finite numbers, none below `low`, from a list; with `one_for_all` also from one number.
  // `value` is the field's, or an element of it; `field` names it in messages.
  std::vector<double> Numbers(const std::string& field, const Json& value, size_t count,
                              bool one_for_all, double low) const;

  std::string Path(const std::string& field) const;
  [[noreturn]] void Reject(const std::string& path, const Json& value,
                           const std::string& remedy) const;
  // Throws for the first field that nobody asked for.
  void RejectUnknown() const;

 private:
  const std::filesystem::path& file_;
  const Json& json_;
  std::string name_;
  std::set<std::string> known_;
};

}  // namespace glint
