#include "base/photos/photo_name.h"

#include <array>
#include <cstdio>
#include <set>

#include "base/text/file_ending.h"

namespace glint {

bool IsVideoFileName(const std::filesystem::path& file) {
  static constexpr std::array kEndings = {".3gp", ".avi", ".m4v", ".mkv",
                                          ".mov", ".mp4", ".mts", ".webm"};
  return HasEnding(file, kEndings);
}

PhotoName SplitPhotoName(const std::filesystem::path& name) {
  constexpr size_t kMostDigits = 8;
  const std::string text = name.string();
  const size_t mark = text.rfind('#');
  if (mark == std::string::npos || mark == 0) return {name, -1};
  const std::string digits = text.substr(mark + 1);
  const bool number = !digits.empty() && digits.size() <= kMostDigits &&
                      digits.find_first_not_of("0123456789") == std::string::npos;
  if (!number || !IsVideoFileName(text.substr(0, mark))) return {name, -1};
  return {text.substr(0, mark), std::stoi(digits)};
}

std::string FrameName(const std::string& video, int frame) {
  char number[16];
  std::snprintf(number, sizeof(number), "#%04d", frame);
  return video + number;
}

std::vector<std::string> FilesOfPhotos(const std::vector<std::string>& names) {
  std::vector<std::string> files;
  std::set<std::string> seen;
  for (const std::string& name : names) {
    const std::string file = SplitPhotoName(name).file.generic_string();
    if (seen.insert(file).second) files.push_back(file);
  }
  return files;
}

bool NamesPhoto(const std::string& name, const std::string& photo) {
  const std::filesystem::path path(photo);
  return photo == name || path.filename() == name || path.stem() == name;
}

std::vector<std::string> RejoinedNames(const std::vector<std::string>& parts,
                                       const std::function<bool(const std::string&)>& known) {
  std::vector<std::string> names;
  for (size_t i = 0; i < parts.size();) {
    std::string name = parts[i];
    size_t used = 1;
    std::string longer = name;
    for (size_t j = i + 1; !known(name) && j < parts.size(); ++j) {
      longer += "," + parts[j];
      if (!known(longer)) continue;
      name = longer;
      used = j + 1 - i;
    }
    names.push_back(name);
    i += used;
  }
  return names;
}

}  // namespace glint
