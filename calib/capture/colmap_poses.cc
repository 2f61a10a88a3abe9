#include "calib/capture/colmap_poses.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <optional>
#include <unordered_map>

#include "base/camera/orientation.h"
#include "base/errors/errors.h"
#include "base/files/files.h"
#include "calib/capture/pose_source.h"
#include "calib/capture/sample_frame.h"
#include "calib/colmap/colmap_camera.h"
#include "calib/colmap/run_colmap.h"

namespace glint {
namespace {

namespace fs = std::filesystem;
using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

// A photograph of the model, in the stored picture whatever COLMAP saw.
struct MatchedPhoto {
  size_t photo = 0;  // of the detected ones
  const ColmapImage* image = nullptr;
  int turns_seen = 0;  // quarter turns from the stored picture to the one that COLMAP saw
  int group = 0;
  Rigid3 camera_from_model;  // stored
};

class PoseTaker {
 public:
  PoseTaker(const Capture& capture, const CalibOptions& options, const fs::path& source,
            ColmapModel model, const std::vector<bool>& upright, CalibSummary* summary)
      : capture_(capture),
        options_(options),
        source_(source),
        model_(std::move(model)),
        upright_(upright),
        summary_(*summary) {
    for (size_t i = 0; i < model_.points.size(); ++i) point_index_[model_.points[i].id] = i;
  }

  void Take() {
    Match();
    FindFrame();
    FillBundle();
    FillMetrics();
  }

  // The model in the sample's frame, its images named as the capture's photographs.
  ColmapModel MovedModel() const {
    ColmapModel moved = model_;
    for (ColmapImage& image : moved.images) {
      image.set_camera_from_model(MovedPose(image.camera_from_model(), frame_.sample_from_model));
    }
    for (const MatchedPhoto& matched : matched_) {
      const auto index = static_cast<size_t>(matched.image - model_.images.data());
      moved.images[index].name = summary_.photos[matched.photo].name;
    }
    for (ColmapPoint& point : moved.points) {
      point.position = frame_.sample_from_model * point.position;
    }
    return moved;
  }

 private:
  void Match() {
    const std::vector<int> match = MatchByName(capture_, source_, summary_.photos, model_);
    CameraGroups& groups = summary_.groups;
    groups = {};
    std::map<std::pair<std::uint32_t, int>, int> known;
    for (size_t i = 0; i < summary_.photos.size(); ++i) {
      groups.turns.push_back(QuarterTurns(summary_.photos[i].orientation).value_or(0));
      groups.group.push_back(0);
      if (match[i] < 0) {
        summary_.photos[i].detection.problem = "the COLMAP model does not contain it";
        continue;
      }
      MatchedPhoto matched;
      matched.photo = i;
      matched.image = &model_.images[static_cast<size_t>(match[i])];
      const ColmapCamera& camera = *model_.FindCamera(matched.image->camera_id);
      matched.turns_seen = TurnsSeen(i, camera);
      matched.camera_from_model =
          TurnedPose(matched.image->camera_from_model(), -matched.turns_seen);
      const auto [at, added] =
          known.insert({{camera.id, matched.turns_seen}, static_cast<int>(groups.groups.size())});
      if (added) AddCamera(camera, matched.turns_seen);
      matched.group = at->second;
      groups.group[i] = matched.group;
      groups.groups[static_cast<size_t>(matched.group)].photos.push_back(i);
      matched_.push_back(matched);
    }
  }

  // COLMAP itself ignores EXIF's orientation; a photograph that someone turned first has the
  // upright size.
  int TurnsSeen(size_t photo, const ColmapCamera& camera) const {
    const DetectedPhoto& detected = summary_.photos[photo];
    const int turns = QuarterTurns(detected.orientation).value_or(0);
    std::uint64_t width = detected.width_px, height = detected.height_px;
    const bool fits_upright = camera.width_px == width && camera.height_px == height;
    if (fits_upright && !upright_.empty() && upright_[photo]) return turns;
    if (turns % 2 == 1) std::swap(width, height);
    if (camera.width_px == width && camera.height_px == height) return 0;
    if (fits_upright) return turns;
    throw UserError(
        source_, fmt::format("camera {}", camera.id),
        fmt::format("{}x{} pixels, while {} has {}x{}", camera.width_px, camera.height_px,
                    detected.name, width, height),
        "the model was made from other or resized photographs; give the one made from these");
  }

  void AddCamera(const ColmapCamera& camera, int turns_seen) {
    const ConvertedCamera converted = ConvertCamera(source_, camera);
    const Camera stored = TurnedCamera(converted.camera, -turns_seen);
    CameraEstimate estimate;
    estimate.camera = stored;
    // Taken as they are: held.
    const auto parameters = static_cast<long>(stored.parameters.size());
    estimate.sigma.assign(stored.parameters.size(), 0);
    estimate.covariance = Eigen::MatrixXd::Zero(parameters, parameters);
    summary_.bundle.cameras.push_back(estimate);
    summary_.groups.groups.push_back({stored.width_px, stored.height_px, {}});
    if (converted.exact) return;
    conversions_.push_back({{"camera", camera.id},
                            {"model", std::string(ColmapModels()[camera.model].name)},
                            {"rms_px", converted.rms_px},
                            {"largest_px", converted.largest_px}});
    spdlog::info(
        "camera {} ({}) was converted to FULL_OPENCV: {:.4f} px RMS, at most {:.4f} px off",
        camera.id, ColmapModels()[camera.model].name, converted.rms_px, converted.largest_px);
  }

  // --- Frame

  // How central in its picture a feature lies, 0 … 1.
  static double Centrality(const ColmapCamera& camera, const Vector2d& point_px) {
    const Vector2d size(static_cast<double>(camera.width_px),
                        static_cast<double>(camera.height_px));
    const double share = (point_px - 0.5 * size).norm() / (0.25 * size.norm());
    return std::exp(-0.5 * share * share);
  }

  std::vector<ModelPoint> WeightedPoints() const {
    std::vector<ModelPoint> points;
    for (const ColmapPoint& point : model_.points) points.push_back({point.position, 0});
    for (const MatchedPhoto& matched : matched_) {
      const ColmapCamera& camera = *model_.FindCamera(matched.image->camera_id);
      for (const ColmapObservation& observation : matched.image->observations) {
        if (observation.point_id == kNoColmapPoint) continue;
        points[point_index_.at(observation.point_id)].weight +=
            Centrality(camera, observation.point_px);
      }
    }
    return points;
  }

  std::vector<PosedPhoto> UprightPhotos() const {
    std::vector<PosedPhoto> photos;
    for (const MatchedPhoto& matched : matched_) {
      const DetectedPhoto& detected = summary_.photos[matched.photo];
      const int turns = summary_.groups.turns[matched.photo];
      PosedPhoto photo;
      photo.name = detected.name;
      photo.camera =
          TurnedCamera(summary_.bundle.cameras[static_cast<size_t>(matched.group)].camera, turns);
      photo.camera_from_model = TurnedPose(matched.camera_from_model, turns);
      if (detected.detection.position_known) {
        for (const CornerObservation& corner : detected.detection.corners) {
          photo.corners.push_back({corner.id, corner.position_in_sample_mm, corner.point_px});
        }
      }
      photos.push_back(photo);
    }
    return photos;
  }

  void FindFrame() {
    FrameOptions frame;
    frame.plane_tolerance = options_.plane_tolerance;
    frame_ = FindSampleFrame(capture_, {source_, UprightPhotos(), WeightedPoints()}, frame);
  }

  // --- Result

  PhotoEstimate Estimate(const MatchedPhoto& matched) const {
    const Camera& camera = summary_.bundle.cameras[static_cast<size_t>(matched.group)].camera;
    PhotoEstimate estimate;
    estimate.name = summary_.photos[matched.photo].name;
    estimate.camera = matched.group;
    estimate.camera_from_sample = MovedPose(matched.camera_from_model, frame_.sample_from_model);
    estimate.sigma_rotation_deg = estimate.sigma_position_mm = kNan;
    const double cosine = std::abs(estimate.camera_from_sample.rotation(2, 2));
    estimate.tilt_deg = std::acos(std::min(cosine, 1.0)) * 180 / std::numbers::pi;
    double squares = 0;
    const ColmapCamera& seen = *model_.FindCamera(matched.image->camera_id);
    for (const ColmapObservation& observation : matched.image->observations) {
      if (observation.point_id == kNoColmapPoint) continue;
      const size_t index = point_index_.at(observation.point_id);
      const Vector3d in_camera = matched.camera_from_model * model_.points[index].position;
      if (!(in_camera.z() > 0)) continue;
      CornerResidual corner;
      corner.id = static_cast<int>(index);
      corner.point_px = TurnedImagePoint(observation.point_px, static_cast<int>(seen.width_px),
                                         static_cast<int>(seen.height_px), -matched.turns_seen);
      corner.residual_px = corner.point_px - ImageFromCamera(camera, in_camera);
      squares += corner.residual_px.squaredNorm();
      estimate.corners.push_back(corner);
    }
    estimate.rms_px = std::sqrt(squares / std::max<size_t>(estimate.corners.size(), 1));
    return estimate;
  }

  void FillBundle() {
    BundleResult& bundle = summary_.bundle;
    double squares = 0;
    for (const MatchedPhoto& matched : matched_) {
      bundle.photos.push_back(Estimate(matched));
      const PhotoEstimate& estimate = bundle.photos.back();
      summary_.photo_index.push_back(matched.photo);
      ++bundle.cameras[static_cast<size_t>(matched.group)].photos;
      bundle.corners += static_cast<int>(estimate.corners.size());
      squares += estimate.rms_px * estimate.rms_px * static_cast<double>(estimate.corners.size());
    }
    bundle.inliers = bundle.corners;
    bundle.rms_px = std::sqrt(squares / std::max(bundle.corners, 1));
  }

  void FillMetrics() {
    const auto unmatched = model_.images.size() - matched_.size();
    summary_.poses = {{"source", "colmap"},
                      {"images", model_.images.size()},
                      {"images_used", matched_.size()},
                      {"points", model_.points.size()},
                      {"plane_points", frame_.plane_points},
                      {"plane_inliers", frame_.plane.inliers},
                      {"plane_share", frame_.plane.share},
                      {"plane_rms_mm", frame_.plane_rms_mm},
                      {"scale_from", frame_.source},
                      {"mm_per_unit", frame_.sample_from_model.scale},
                      {"fit_rms_mm", frame_.fit_rms_mm},
                      {"board_photos", frame_.board_photos},
                      {"board_corners", frame_.board_corners},
                      {"converted_cameras", conversions_}};
    if (unmatched > 0) {
      spdlog::info(
          "{} of the model's {} images are not photographs of the capture; they are not "
          "used",
          unmatched, model_.images.size());
    }
  }

  const Capture& capture_;
  const CalibOptions& options_;
  fs::path source_;
  ColmapModel model_;
  std::vector<bool> upright_;
  CalibSummary& summary_;
  std::unordered_map<std::uint64_t, size_t> point_index_;
  std::vector<MatchedPhoto> matched_;
  SampleFrame frame_;
  Json conversions_ = Json::array();
};

ColmapRun RunOnCapture(const Capture& capture, const CalibOptions& options,
                       const CommonOptions& common, const CalibSummary& summary) {
  const CameraGroups groups = GroupCameras(capture.file, options.cameras, summary.photos, false);
  std::vector<ColmapPhoto> photos;
  for (size_t i = 0; i < summary.photos.size(); ++i) {
    const std::string& name = summary.photos[i].name;
    photos.push_back({capture.folder / name, name, groups.group[i]});
  }
  ColmapRunOptions run;
  run.camera_model = options.model == "auto" ? CalibOptions().model : options.model;
  run.largest_px = options.feature_px;
  run.encoding = capture.encoding;
  run.seed = common.seed;
  run.force = common.force;
  return RunColmap(photos, run, capture.work() / "colmap-run");
}

}  // namespace

void PosesFromColmap(const Capture& capture, const CalibOptions& options,
                     const CommonOptions& common, Stage* stage, CalibSummary* summary) {
  ColmapRun run;
  fs::path source = capture.work() / "colmap-run" / "model";
  if (PoseSourceOf(capture, options) == PoseSource::kColmapProgram) {
    run = RunOnCapture(capture, options, common, *summary);
  } else {
    source = PosesFolder(capture, options);
    run.model = ReadColmapModel(source);
  }
  PoseTaker taker(capture, options, source, std::move(run.model), run.upright, summary);
  taker.Take();
  const fs::path cameras = stage->Output("colmap/cameras.bin");
  stage->Output("colmap/images.bin");
  stage->Output("colmap/points3D.bin");
  WriteColmapModel(cameras.parent_path(), taker.MovedModel(), ColmapFormat::kBinary);
}

}  // namespace glint
