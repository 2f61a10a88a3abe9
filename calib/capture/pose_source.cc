#include "calib/capture/pose_source.h"

#include <fmt/format.h>

#include <map>
#include <string>

#include "base/errors/errors.h"
#include "calib/colmap/run_colmap.h"

namespace glint {
namespace {

namespace fs = std::filesystem;

constexpr char kPrefix[] = "colmap:";

}  // namespace

PoseSource PoseSourceOf(const Capture& capture, const CalibOptions& options) {
  if (capture.fixed_camera()) return PoseSource::kFixedCamera;
  if (options.poses == "board") return PoseSource::kBoard;
  if (options.poses == "above") return PoseSource::kAbove;
  if (options.poses == "colmap") return PoseSource::kColmapProgram;
  if (options.poses.starts_with(kPrefix) && options.poses.size() > sizeof(kPrefix) - 1) {
    return PoseSource::kColmapModel;
  }
  throw UserError(
      "--poses: found '" + options.poses +
      "'; use board, colmap (the program is run), colmap:DIR (a model is read), or above (one "
      "photograph from straight above)");
}

fs::path PosesFolder(const Capture& capture, const CalibOptions& options) {
  const fs::path given = options.poses.substr(sizeof(kPrefix) - 1);
  return fs::exists(given) || given.is_absolute() ? given : capture.folder / given;
}

void CheckPoses(const Capture& capture, const CalibOptions& options) {
  const PosesTable& poses = capture.poses;
  if (capture.fixed_camera()) return;
  if (PoseSourceOf(capture, options) == PoseSource::kAbove) {
    if (poses.picture_width_mm > 0 || poses.height_mm > 0) return;
    throw UserError(capture.file, "poses", "no length",
                    "a photograph without a board has no scale: give picture_width_mm (how "
                    "much of the sample its width shows) or height_mm (of the lens) in [poses]");
  }
  const bool scale = !poses.corners_px.empty() || poses.points_mm > 0 || poses.cameras_mm > 0 ||
                     poses.height_mm > 0;
  if (!scale && !capture.has_board) {
    throw UserError(
        capture.file, "poses", "no length",
        "a COLMAP model has no scale in millimetres: give corners_px, points_mm, cameras_mm "
        "or height_mm in [poses] (docs/capture.md), or describe a [board] that some "
        "photographs show");
  }
  if (PoseSourceOf(capture, options) == PoseSource::kColmapProgram) FindColmap();
}

std::vector<int> MatchByName(const Capture& capture, const fs::path& source,
                             const std::vector<DetectedPhoto>& photos, const ColmapModel& model) {
  std::map<std::string, std::vector<int>> by_path, by_file;
  for (size_t i = 0; i < model.images.size(); ++i) {
    const fs::path name = model.images[i].name;
    by_path[name.generic_string()].push_back(static_cast<int>(i));
    by_file[name.filename().string()].push_back(static_cast<int>(i));
  }
  std::vector<int> match(photos.size(), -1);
  size_t matched = 0;
  for (size_t i = 0; i < photos.size(); ++i) {
    const std::string file = fs::path(photos[i].name).filename().string();
    auto found = by_path.find(photos[i].name);
    if (found == by_path.end()) {
      found = by_file.find(file);
      if (found == by_file.end()) continue;
    }
    if (found->second.size() > 1) {
      throw UserError(source, "images",
                      fmt::format("{} images called {}", found->second.size(), found->first),
                      "give the photographs different names");
    }
    match[i] = found->second[0];
    ++matched;
  }
  if (matched > 0) return match;
  throw UserError(
      source, "images",
      fmt::format("{} images ({}, …), none of which is a photograph of {}", model.images.size(),
                  model.images.empty() ? "" : model.images[0].name, capture.file.string()),
      fmt::format("give the model of this capture: its photographs are called {}, …",
                  photos.empty() ? "" : photos[0].name));
}

}  // namespace glint
