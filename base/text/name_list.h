// Names in a sentence.
#pragma once

#include <algorithm>
#include <string>
#include <vector>

namespace glint {

// "a.jpg, b.jpg and 3 more": the first `most` of them.
inline std::string NameList(const std::vector<std::string>& names, size_t most = 3) {
  std::string text;
  for (size_t i = 0; i < std::min(most, names.size()); ++i) text += (i > 0 ? ", " : "") + names[i];
  if (names.size() > most) text += " and " + std::to_string(names.size() - most) + " more";
  return text;
}

// "a, b and c": all of them, `conjunction` ("and", "or") before the last.
inline std::string NameList(const std::vector<std::string>& names, const std::string& conjunction) {
  std::string text;
  for (size_t i = 0; i < names.size(); ++i) {
    const bool last = i + 1 == names.size();
    text += (i == 0 ? "" : last ? " " + conjunction + " " : ", ") + names[i];
  }
  return text;
}

}  // namespace glint
