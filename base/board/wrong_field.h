// How errors in a board's description are said.
#pragma once

#include <string>

namespace glint {

inline std::string WrongField(const std::string& field, const std::string& found,
                              const std::string& remedy) {
  return field + ": found " + found + "; " + remedy;
}

}  // namespace glint
