#include "base/formats/capture_files.h"

#include <fnmatch.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "base/errors/errors.h"
#include "base/files/json.h"
#include "base/photos/photo_name.h"
#include "base/photos/video.h"

namespace glint {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMaxPhotos = 10000;
constexpr int kUsualEvery = 15;  // half a second of most videos

// What a directory's entry is that is no file.
std::string WhatElse(const fs::directory_entry& entry) {
  std::error_code error;
  if (entry.is_symlink(error) && !entry.exists(error)) return "a broken link";
  if (entry.is_directory(error)) return "a folder";
  return "something other than a regular file (a pipe or a device, say)";
}

// One frame in `every` of a video, from the first.
std::vector<std::string> FramesOf(const fs::path& folder, const std::string& video, int every) {
  const VideoInfo info = ReadVideoInfo(folder / video);
  if (info.missing > 0) {
    spdlog::warn("{}: the video is truncated; its {} complete frames are used, {} are missing",
                 (folder / video).string(), info.frames, info.missing);
  }
  std::vector<std::string> names;
  for (int frame = 0; frame < info.frames; frame += every) names.push_back(FrameName(video, frame));
  return names;
}

}  // namespace

std::vector<std::string> MatchFiles(const fs::path& folder, const std::string& pattern,
                                    const fs::path& file, const std::string& field) {
  const fs::path relative(pattern);
  if (relative.is_absolute() || pattern.find("..") != std::string::npos) {
    throw UserError(file, field, "'" + pattern + "'", "give a path inside the capture's folder");
  }
  if (pattern.find_first_of("*?[") == std::string::npos) {
    if (!fs::is_regular_file(folder / relative)) {
      throw UserError(file, field, "no file '" + pattern + "'", "check the name");
    }
    return {relative.generic_string()};
  }
  std::vector<std::string> found;
  const fs::path where = folder / relative.parent_path();
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(where, error)) {
    const std::string name = entry.path().filename();
    if (name[0] == '.') continue;
    if (fnmatch(relative.filename().c_str(), name.c_str(), FNM_CASEFOLD) != 0) continue;
    std::error_code missing;
    if (entry.is_regular_file(missing)) {
      found.push_back((relative.parent_path() / name).generic_string());
    } else {
      spdlog::warn("{}: left out: it matches '{}', but is {}", entry.path().string(), pattern,
                   WhatElse(entry));
    }
  }
  std::sort(found.begin(), found.end());
  return found;
}

void RequireUtf8(const fs::path& file, const std::string& field, const std::string& name) {
  try {
    (void)Json(name).dump();
  } catch (const nlohmann::json::exception&) {
    throw UserError(file, field,
                    "'" + Json(name).dump(-1, ' ', true, Json::error_handler_t::replace) +
                        "', a name whose bytes are not UTF-8",
                    "rename the file, or convert names with: convmv -f latin1 -t utf8 --notest");
  }
}

std::vector<std::string> ReadPhotos(const fs::path& folder, const std::string& key,
                                    TomlTable* table, const fs::path& file,
                                    std::vector<std::string>* left_out) {
  const auto patterns = table->Texts(key, "give a list of patterns such as [\"photos/*.jpg\"]");
  const auto videos = table->Texts("video", "give a name such as \"clip.mp4\", or a list of them");
  const int every = static_cast<int>(
      std::lround(table->Number("every", kUsualEvery, 1, 1e6, " of frames, at least 1")));
  std::vector<std::string> all;
  std::set<std::string> seen;
  const auto add = [&](const std::string& name) {
    RequireUtf8(file, table->name() + "." + key, name);
    if (seen.insert(name).second) all.push_back(name);
  };
  for (const std::string& pattern : patterns) {
    for (const std::string& name : MatchFiles(folder, pattern, file, table->name() + "." + key)) {
      add(name);
    }
  }
  for (const std::string& pattern : videos) {
    for (const std::string& video : MatchFiles(folder, pattern, file, table->name() + ".video")) {
      for (const std::string& name : FramesOf(folder, video, every)) add(name);
    }
  }
  if (left_out != nullptr) {
    const auto names =
        table->Texts("left_out", "give a list of files such as [\"photos/IMG_0007.jpg\"]");
    const auto used = [&](const std::string& photo) {
      return std::find(names.begin(), names.end(), photo) == names.end();
    };
    const auto rest = std::stable_partition(all.begin(), all.end(), used);
    left_out->assign(rest, all.end());
    all.erase(rest, all.end());
  }
  if (all.size() > kMaxPhotos) {
    throw UserError(file, table->name(), std::to_string(all.size()) + " photographs",
                    "at most " + std::to_string(kMaxPhotos) + " are read");
  }
  return all;
}

}  // namespace glint
