// How deeply a JSON text is nested, before a parser is let loose on it: parsers and what walks
// their results recurse, and a file of 100,000 brackets would end the program on its stack.
#pragma once

#include <algorithm>
#include <string_view>

namespace glint {

// Deeper than anything that Glint writes or reads (manifests: 8).
inline constexpr int kMostJsonDepth = 64;

// The deepest nesting of brackets and braces outside strings; the text need not be valid.
inline int JsonDepth(std::string_view text) {
  int depth = 0, deepest = 0;
  bool in_string = false;
  for (size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (in_string) {
      if (c == '\\') ++i;
      if (c == '"') in_string = false;
    } else if (c == '"') {
      in_string = true;
    } else if (c == '[' || c == '{') {
      deepest = std::max(deepest, ++depth);
    } else if (c == ']' || c == '}') {
      --depth;
    }
  }
  return deepest;
}

}  // namespace glint
