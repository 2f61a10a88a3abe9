#include <fmt/format.h>

#include <cmath>
#include <unordered_map>

#include "base/errors/errors.h"
#include "calib/colmap/colmap_camera.h"
#include "calib/colmap/model_io.h"

namespace glint::colmap {
namespace {

namespace fs = std::filesystem;

constexpr std::uint64_t kLargestSide_px = 1000000;
constexpr char kExportAgain[] = "the file is damaged; export the model again";

// Index of each id. Throws where one is there twice.
template <class Item>
std::unordered_map<std::uint64_t, size_t> IndexOf(const fs::path& file, const std::string& what,
                                                  const std::vector<Item>& items) {
  std::unordered_map<std::uint64_t, size_t> index;
  index.reserve(items.size());
  for (size_t i = 0; i < items.size(); ++i) {
    if (index.emplace(items[i].id, i).second) continue;
    throw UserError(file, fmt::format("{} {}", what, items[i].id), "the same id twice",
                    kExportAgain);
  }
  return index;
}

}  // namespace

void RejectCameraModel(const fs::path& file, std::uint32_t camera, const std::string& found) {
  std::string known;
  for (const ColmapModelInfo& info : ColmapModels()) {
    known += (known.empty() ? "" : ", ") + std::string(info.name);
  }
  throw UserError(
      file, fmt::format("camera {}", camera), "camera model " + found,
      "it is not one of COLMAP 3.8's (" + known +
          "): the file is damaged or was written by another version; use that version to calibrate "
          "with one of these models, or to undistort the photographs");
}

void CheckCamera(const fs::path& file, const ColmapCamera& camera) {
  const std::string field = fmt::format("camera {}", camera.id);
  if (camera.width_px < 1 || camera.height_px < 1 || camera.width_px > kLargestSide_px ||
      camera.height_px > kLargestSide_px) {
    throw UserError(file, field, fmt::format("{}x{} pixels", camera.width_px, camera.height_px),
                    kExportAgain);
  }
  for (const double value : camera.parameters) {
    if (!std::isfinite(value)) {
      throw UserError(file, field, "a parameter that is not a number", kExportAgain);
    }
  }
  const size_t focal_lengths = ColmapModels()[camera.model].focal_lengths;
  for (size_t i = 0; i < focal_lengths; ++i) {
    if (camera.parameters[i] > 0) continue;
    throw UserError(file, field, fmt::format("a focal length of {}", camera.parameters[i]),
                    kExportAgain);
  }
}

void CheckImage(const fs::path& file, const ColmapImage& image) {
  const std::string field = fmt::format("image {}", image.id);
  double norm = 0;
  for (const double q : image.quaternion_wxyz) norm += q * q;
  if (!(norm > 1e-12) || !std::isfinite(norm) || !image.translation.allFinite()) {
    throw UserError(file, field, "an invalid pose", kExportAgain);
  }
  if (image.name.empty() || image.name.size() > kLongestName) {
    throw UserError(file, field, "a name of " + std::to_string(image.name.size()) + " letters",
                    kExportAgain);
  }
  for (const ColmapObservation& observation : image.observations) {
    if (observation.point_px.allFinite()) continue;
    throw UserError(file, field, "a feature with invalid coordinates", kExportAgain);
  }
}

void CheckPoint(const fs::path& file, const ColmapPoint& point) {
  if (point.position.allFinite() && std::isfinite(point.error_px)) return;
  throw UserError(file, fmt::format("point {}", point.id),
                  "a position or error that is not a number", kExportAgain);
}

void CheckModel(const std::vector<fs::path>& files, const ColmapModel& model) {
  const auto cameras = IndexOf(files[0], "camera", model.cameras);
  const auto images = IndexOf(files[1], "image", model.images);
  const auto points = IndexOf(files[2], "point", model.points);
  const std::string remedy = "the three files do not belong to one model; export it again";
  for (const ColmapImage& image : model.images) {
    const std::string field = fmt::format("image {} ({})", image.id, image.name);
    if (cameras.count(image.camera_id) == 0) {
      throw UserError(files[1], field,
                      fmt::format("camera {}, which {} does not have", image.camera_id,
                                  files[0].filename().string()),
                      remedy);
    }
    for (const ColmapObservation& observation : image.observations) {
      if (observation.point_id == kNoColmapPoint || points.count(observation.point_id) > 0)
        continue;
      throw UserError(files[1], field,
                      fmt::format("point {}, which {} does not have", observation.point_id,
                                  files[2].filename().string()),
                      remedy);
    }
  }
  for (const ColmapPoint& point : model.points) {
    for (const ColmapTrackElement& element : point.track) {
      const auto image = images.find(element.image_id);
      if (image != images.end() &&
          element.observation < model.images[image->second].observations.size()) {
        continue;
      }
      throw UserError(
          files[2], fmt::format("point {}", point.id),
          fmt::format("feature {} of image {}, which {} does not have", element.observation,
                      element.image_id, files[1].filename().string()),
          remedy);
    }
  }
}

}  // namespace glint::colmap
