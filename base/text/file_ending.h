// Endings of file names.
#pragma once

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <string>

namespace glint {

// Whether `file` has one of `endings` (".jpg"), whatever the case of its letters.
template <class Endings>
bool HasEnding(const std::filesystem::path& file, const Endings& endings) {
  std::string ending = file.extension().string();
  std::transform(ending.begin(), ending.end(), ending.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return std::find(std::begin(endings), std::end(endings), ending) != std::end(endings);
}

}  // namespace glint
