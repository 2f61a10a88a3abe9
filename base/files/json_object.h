// One object of a JSON file that a person may have written, read key by key: what is wrong is said
// with file, field, what was found and the remedy; what is not asked for is unknown in the end.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "base/files/json.h"

namespace glint {

// A value as messages show it: cut off where it is long, in ASCII.
std::string Describe(const Json& value);

class JsonObject {
 public:
  // `name` is the object's place in the file ("" at the top). Throws UserError: no object. `json`
  // must outlive this.
  JsonObject(std::filesystem::path file, std::string name, const Json& json);

  bool Has(const std::string& key) const;
  double Number(const std::string& key, double low, double high, const std::string& remedy);
  int Integer(const std::string& key, const std::string& remedy);
  bool Flag(const std::string& key);
  std::string Text(const std::string& key, const std::string& remedy);
  std::vector<double> Numbers(const std::string& key, size_t count, const std::string& remedy);
  std::vector<int> Integers(const std::string& key, size_t count, const std::string& remedy);
  // A list; of `count` elements where that is not 0.
  const Json& Array(const std::string& key, size_t count, const std::string& remedy);
  JsonObject Member(const std::string& key);
  JsonObject Element(const std::string& key, size_t index);

  [[noreturn]] void Reject(const std::string& key, const std::string& remedy) const;
  void RejectUnknown() const;  // throws on the first key that nobody asked for

 private:
  const Json& Find(const std::string& key, const std::string& remedy);
  std::string Field(const std::string& key) const;

  std::filesystem::path file_;
  std::string name_;
  const Json& json_;
  mutable std::vector<std::string> known_;
};

}  // namespace glint
