#include "calib/capture/export_colmap.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

#include "base/board/board.h"
#include "base/camera/orientation.h"
#include "base/errors/errors.h"
#include "base/files/files.h"
#include "base/formats/calibration.h"
#include "base/formats/manifest.h"
#include "calib/bundle/bundle.h"
#include "calib/colmap/colmap_camera.h"

namespace glint {
namespace {

namespace fs = std::filesystem;

class ModelBuilder {
 public:
  ModelBuilder(const Capture& capture, const fs::path& manifest_file)
      : manifest_file_(manifest_file),
        calibration_(ReadCalibration(manifest_file)),
        metrics_(ReadManifest(manifest_file, "calib").metrics),
        residuals_file_(manifest_file.parent_path() / "residuals.json") {
    residuals_ = Json::parse(ReadTextFile(residuals_file_), nullptr, false);
    const std::optional<BoardBend> bend = Bend();
    for (const BoardCorner& corner : BoardCorners(capture.board)) {
      corners_[corner.id].position = BoardPoint(bend, corner.position_in_sample_mm);
    }
  }

  ColmapModel Build() {
    for (const CalibratedPhoto& photo : calibration_.photos) AddPhoto(photo);
    for (auto& [id, point] : corners_) {
      if (point.track.empty()) continue;
      point.id = PointId(id);
      point.rgb = {128, 128, 128};
      point.error_px /= static_cast<double>(point.track.size());
      model_.points.push_back(point);
    }
    return std::move(model_);
  }

 private:
  // Of the board, where poses were solved for with it.
  std::optional<BoardBend> Bend() const {
    if (!metrics_.contains("diagnosis")) return std::nullopt;
    const Json& diagnosis = metrics_["diagnosis"];
    if (!diagnosis.contains("board_bend")) return std::nullopt;
    const Json& found = diagnosis["board_bend"];
    if (!found.value("solved_for", false)) return std::nullopt;
    const std::string where = "metrics.diagnosis.board_bend";
    const auto pair = [&](const char* field) {
      const std::vector<double> values = RequireNumbers(manifest_file_, found, where, field, 2);
      return Eigen::Vector2d(values[0], values[1]);
    };
    BoardBend bend;
    bend.centre_mm = pair("centre_mm");
    bend.half_size_mm = pair("half_size_mm");
    bend.height_mm = pair("height_mm");
    return bend;
  }
  static std::uint64_t PointId(int corner) { return static_cast<std::uint64_t>(corner) + 1; }

  int TurnsOf(const std::string& name) const {
    for (const Json& photo : RequireField(manifest_file_, metrics_, "metrics", "photos")) {
      if (RequireString(manifest_file_, photo, "metrics.photos", "photo") != name) continue;
      return static_cast<int>(
          RequireNumber(manifest_file_, photo, "metrics.photos", "quarter_turns"));
    }
    throw UserError(manifest_file_, "metrics.photos", "no entry for " + name, "run calib again");
  }

  // Number of the camera, one for each that differs.
  std::uint32_t CameraId(const Camera& stored) {
    const ColmapCamera camera =
        ToColmapCamera(stored, static_cast<std::uint32_t>(model_.cameras.size() + 1));
    for (const ColmapCamera& known : model_.cameras) {
      if (known.model == camera.model && known.parameters == camera.parameters &&
          known.width_px == camera.width_px && known.height_px == camera.height_px) {
        return known.id;
      }
    }
    model_.cameras.push_back(camera);
    return camera.id;
  }

  void AddPhoto(const CalibratedPhoto& photo) {
    const int turns = TurnsOf(photo.photo);
    const Camera& upright = calibration_.cameras[static_cast<size_t>(photo.camera)];
    ColmapImage image;
    image.id = static_cast<std::uint32_t>(model_.images.size() + 1);
    image.name = photo.photo;
    image.camera_id = CameraId(TurnedCamera(upright, -turns));
    image.set_camera_from_model(TurnedPose(photo.camera_from_sample, -turns));
    const Json& all = RequireField(residuals_file_, residuals_, "", "photos");
    const Json& rows = RequireField(residuals_file_, all, "photos", photo.photo);
    for (const Json& row : rows) AddCorner(row, &image);
    model_.images.push_back(std::move(image));
  }

  // [corner id, x, y, residual x, residual y, inlier], of the stored picture.
  void AddCorner(const Json& row, ColmapImage* image) {
    if (!row.is_array() || row.size() != 6 || !row[5].is_boolean()) {
      throw UserError(residuals_file_, "photos", row.dump(), "run calib again");
    }
    if (!row[5].get<bool>()) return;
    const auto corner = corners_.find(row[0].get<int>());
    if (corner == corners_.end()) return;
    corner->second.track.push_back(
        {image->id, static_cast<std::uint32_t>(image->observations.size())});
    corner->second.error_px += std::hypot(row[3].get<double>(), row[4].get<double>());
    image->observations.push_back(
        {{row[1].get<double>(), row[2].get<double>()}, PointId(corner->first)});
  }

  fs::path manifest_file_;
  Calibration calibration_;
  Json metrics_;
  fs::path residuals_file_;
  Json residuals_;
  std::map<int, ColmapPoint> corners_;
  ColmapModel model_;
};

}  // namespace

ColmapModel ModelOfCalibration(const Capture& capture, const fs::path& manifest_file) {
  const Json metrics = ReadManifest(manifest_file, "calib").metrics;
  if (metrics.contains("poses")) return ReadColmapModel(manifest_file.parent_path() / "colmap");
  return ModelBuilder(capture, manifest_file).Build();
}

fs::path ExportColmap(const Capture& capture, const fs::path& manifest_file) {
  const ColmapModel model = ModelOfCalibration(capture, manifest_file);
  fs::path folder = capture.work() / "colmap";
  fs::create_directories(folder);
  WriteColmapModel(folder, model, ColmapFormat::kBinary);
  return folder;
}

}  // namespace glint
