#include "calib/moving_light/lights_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>

#include "base/errors/errors.h"
#include "base/text/file_ending.h"
#include "base/text/name_list.h"
#include "calib/moving_light/lights_file_formats.h"

namespace glint {
namespace {

namespace fs = std::filesystem;

struct LightsFormat {
  const char* ending;
  LightsFile (*read)(const fs::path& file, const std::string& unit, double picture_width_mm);
};

LightsFile ReadRelight(const fs::path& file, const std::string&, double picture_width_mm) {
  return ReadRelightFile(file, picture_width_mm);
}

constexpr LightsFormat kLightsFormats[] = {
    {".lp",
     [](const fs::path& file, const std::string& unit, double) { return ReadLpFile(file, unit); }},
    {".relight", ReadRelight},
    {".dome", ReadRelight},
};

std::string Folded(std::string text) {
  for (char& c : text) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  return text;
}

std::string Stem(const std::string& name) { return fs::path(name).stem().string(); }

// Photographs by a key of their names. Throws where two have the same.
std::map<std::string, int> IndexOf(const LightsFile& file, const std::vector<std::string>& photos,
                                   std::string (*key)(const std::string& name)) {
  std::map<std::string, int> index;
  for (size_t i = 0; i < photos.size(); ++i) {
    const auto [at, added] = index.insert({key(WithoutFolders(photos[i])), static_cast<int>(i)});
    if (added) continue;
    throw UserError(file.file, "",
                    fmt::format("{} and {}, which it cannot distinguish",
                                photos[static_cast<size_t>(at->second)], photos[i]),
                    "name one of them in [photos] files, or rename them");
  }
  return index;
}

// −1 for lights without a photograph.
std::vector<int> PhotosByName(const LightsFile& file, const std::vector<std::string>& photos) {
  const auto whole = IndexOf(file, photos, [](const std::string& name) { return Folded(name); });
  std::map<std::string, int> stems;
  std::vector<int> found;
  for (const ListedLight& light : file.lights) {
    const auto at = whole.find(Folded(light.photo));
    if (at != whole.end()) {
      found.push_back(at->second);
      continue;
    }
    if (stems.empty()) {
      stems = IndexOf(file, photos, [](const std::string& name) { return Folded(Stem(name)); });
    }
    const auto stem = stems.find(Folded(Stem(light.photo)));
    found.push_back(stem == stems.end() ? -1 : stem->second);
  }
  return found;
}

std::vector<int> InOrder(size_t photos) {
  std::vector<int> order;
  for (size_t i = 0; i < photos; ++i) order.push_back(static_cast<int>(i));
  return order;
}

}  // namespace

std::string LightsFileEndings() {
  std::vector<std::string> endings;
  for (const LightsFormat& format : kLightsFormats) endings.emplace_back(format.ending);
  return NameList(endings, "or");
}

LightsFile ReadLightsFile(const fs::path& file, const std::string& unit, double picture_width_mm) {
  for (const LightsFormat& format : kLightsFormats) {
    if (!HasEnding(file, std::array{std::string(format.ending)})) continue;
    LightsFile read = format.read(file, unit, picture_width_mm);
    if (!read.lights.empty()) return read;
    throw UserError(file, "", "no lights", "give a file that lists one for each photograph");
  }
  throw UserError(
      file, "",
      "'" + file.extension().string() + "', which is not an extension of a list of lights",
      "give one that ends in " + LightsFileEndings());
}

std::vector<int> MatchLights(const LightsFile& file, const std::vector<std::string>& photos,
                             std::vector<std::string>* remarks) {
  const bool as_many = file.lights.size() == photos.size();
  if (!file.has_names()) {
    if (as_many) return InOrder(photos.size());
    throw UserError(file.file, "",
                    fmt::format("{} lights without names for {} photographs", file.lights.size(),
                                photos.size()),
                    "name those that it lists, and no others, in [photos] files");
  }
  const std::vector<int> photo_of = PhotosByName(file, photos);
  std::vector<int> lights(photos.size(), -1);
  std::vector<std::string> missing;
  for (size_t i = 0; i < photo_of.size(); ++i) {
    if (photo_of[i] < 0) {
      missing.push_back(file.lights[i].photo);
      continue;
    }
    int& light = lights[static_cast<size_t>(photo_of[i])];
    if (light >= 0) {
      throw UserError(file.file, "", fmt::format("two lights of {}", file.lights[i].photo),
                      "remove one of them");
    }
    light = static_cast<int>(i);
  }
  if (missing.size() == file.lights.size() && as_many) {
    remarks->push_back(
        fmt::format("{}: none of its names ({}) is a photograph's; lights are assigned to "
                    "photographs in order, {} first",
                    file.file.string(), NameList(missing, 2), photos[0]));
    return InOrder(photos.size());
  }
  if (missing.empty()) return lights;
  throw UserError(file.file, "",
                  fmt::format("{} of {} names without a photograph: {}", missing.size(),
                              file.lights.size(), NameList(missing)),
                  "add the photographs to the capture, or remove their lines");
}

}  // namespace glint
