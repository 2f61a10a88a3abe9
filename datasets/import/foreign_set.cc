#include "datasets/import/foreign_set.h"

#include <algorithm>
#include <utility>

#include "base/errors/errors.h"

namespace glint {
namespace {

namespace fs = std::filesystem;

constexpr char kRemedy[] =
    "give a folder with views.json, with camera_pos.txt (MaterialGAN), parameters.json or "
    "optim_*.json (svbrdf-diff-renderer), or DIR's NAME.txt in a folder *wlv";

bool EndsWithWlv(const fs::path& folder) {
  const std::string name = folder.filename();
  return name.size() >= 3 && name.compare(name.size() - 3, 3, "wlv") == 0;
}

// The .txt files of the folder *wlv within `folder` (or of `folder` itself).
std::vector<fs::path> WlvFiles(const fs::path& folder) {
  std::vector<fs::path> files;
  const auto collect = [&](const fs::path& where) {
    for (const auto& entry : fs::directory_iterator(where)) {
      if (entry.is_regular_file() && entry.path().extension() == ".txt")
        files.push_back(entry.path());
    }
  };
  if (EndsWithWlv(folder)) collect(folder);
  for (const auto& entry : fs::directory_iterator(folder)) {
    if (entry.is_directory() && EndsWithWlv(entry.path())) collect(entry.path());
  }
  std::sort(files.begin(), files.end());
  return files;
}

// svbrdf-diff-renderer's descriptions in a folder: one for each resolution (optim_latent_256.json
// …).
std::vector<fs::path> MaterialGanFiles(const fs::path& folder) {
  std::vector<fs::path> files;
  for (const auto& entry : fs::directory_iterator(folder)) {
    if (IsMaterialGanJson(entry.path())) files.push_back(entry.path());
  }
  std::sort(files.begin(), files.end());
  return files;
}

ForeignSet ReadFolder(const fs::path& folder) {
  if (fs::is_regular_file(folder / "views.json")) return ReadViewsJson(folder / "views.json");
  if (fs::is_regular_file(folder / "camera_pos.txt")) return ReadMaterialGanText(folder);
  if (fs::is_regular_file(folder / "parameters.json")) {
    return ReadMaterialGanJson(folder / "parameters.json");
  }
  const std::vector<fs::path> described = MaterialGanFiles(folder);
  if (described.size() == 1) return ReadMaterialGanJson(described[0]);
  if (described.size() > 1) {
    throw UserError(folder, "", std::to_string(described.size()) + " descriptions of a set",
                    "name one of them, for example " + described.back().string());
  }
  const std::vector<fs::path> wlv = WlvFiles(folder);
  if (wlv.size() == 1) return ReadDirSet(wlv[0]);
  if (wlv.size() > 1) {
    throw UserError(folder, "", std::to_string(wlv.size()) + " sets in a folder *wlv",
                    "name one of them, for example " + wlv[0].string());
  }
  throw UserError(folder, "", "a folder of unknown layout", kRemedy);
}

}  // namespace

std::string_view ForeignLayoutName(ForeignLayout layout) {
  switch (layout) {
    case ForeignLayout::kViewsJson:
      return "views.json";
    case ForeignLayout::kMaterialGanText:
      return "MaterialGAN (camera_pos.txt)";
    case ForeignLayout::kMaterialGanJson:
      return "svbrdf-diff-renderer (.json)";
    case ForeignLayout::kDirWlv:
      return "DIR 2019 (wlv)";
  }
  return "";
}

ForeignSet ReadForeignSet(const fs::path& source) {
  if (fs::is_directory(source)) return ReadFolder(source);
  if (!fs::is_regular_file(source)) throw UserError(source, "", "no such file or folder", kRemedy);
  if (source.filename() == "parameters.json" || IsMaterialGanJson(source)) {
    return ReadMaterialGanJson(source);
  }
  if (source.extension() == ".json") return ReadViewsJson(source);
  if (EndsWithWlv(fs::absolute(source).parent_path())) return ReadDirSet(source);
  throw UserError(source, "", "a file of unknown layout", kRemedy);
}

void RequireInFront(const fs::path& file, const std::string& field, const View& view) {
  for (const auto& [what, z] : {std::pair{"camera", view.camera_in_sample_mm[2]},
                                std::pair{"light", view.light_in_sample_mm[2]}}) {
    if (z > 0) continue;
    throw UserError(file, field, "a " + std::string(what) + " at z = " + std::to_string(z) + " mm",
                    "it must be in front of the sample, at z > 0");
  }
}

}  // namespace glint
