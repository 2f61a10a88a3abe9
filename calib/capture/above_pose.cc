#include "calib/capture/above_pose.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include "base/camera/orientation.h"
#include "base/errors/errors.h"
#include "calib/capture/assumed_camera.h"

namespace glint {
namespace {

// Above the sample's middle; the camera's y axis points down, its z axis at the sample.
Rigid3 CameraAbove(double height_mm) {
  Rigid3 pose;
  pose.rotation = Eigen::Vector3d(1, -1, -1).asDiagonal();
  pose.translation = {0, 0, height_mm};
  return pose;
}

void RequireInPicture(const Capture& capture, double width_mm, double height_mm) {
  const auto& size = capture.sample_size_mm;
  if (size[0] <= width_mm && size[1] <= height_mm) return;
  throw UserError(capture.file, "sample.size_mm", fmt::format("{} x {} mm", size[0], size[1]),
                  fmt::format("the photograph shows {:.4g} x {:.4g} mm: reduce size_mm, or "
                              "correct picture_width_mm in [poses]",
                              width_mm, height_mm));
}

}  // namespace

void PoseFromAbove(const Capture& capture, const CalibOptions& options, CalibSummary* summary) {
  if (summary->photos.size() != 1) {
    throw UserError(
        capture.file, "photos.files", fmt::format("{} photographs", summary->photos.size()),
        "poses = \"above\" is for one photograph: name only that one, or for several lay a "
        "board round the sample (docs/capture.md) or use poses = \"colmap\"");
  }
  const DetectedPhoto& photo = summary->photos[0];
  summary->groups = GroupCameras(capture.file, options.cameras, summary->photos);
  const CameraGroup& group = summary->groups.groups[0];
  const Camera camera = AssumedCamera(summary->photos, group, CameraModel::kOpenCv);
  const double focal_px = camera.focal_length_x();
  const double height_mm = capture.poses.height_mm > 0
                               ? capture.poses.height_mm
                               : capture.poses.picture_width_mm * focal_px / photo.width_px;
  RequireInPicture(capture, height_mm * photo.width_px / focal_px,
                   height_mm * photo.height_px / focal_px);
  const bool reported = ReportedFocal_px(summary->photos, group) > 0;
  if (!reported) {
    spdlog::warn("{}: EXIF reports no focal length; that of a phone's main camera is assumed",
                 photo.name);
  }
  CameraEstimate estimate;
  estimate.camera = camera;
  const auto parameters = static_cast<Eigen::Index>(camera.parameters.size());
  estimate.sigma.assign(camera.parameters.size(), 0);
  estimate.covariance = Eigen::MatrixXd::Zero(parameters, parameters);
  estimate.photos = 1;
  summary->bundle.cameras = {estimate};
  PhotoEstimate pose;
  pose.name = photo.name;
  const int turns = summary->groups.turns[0];
  pose.camera_from_sample = TurnedPose(CameraAbove(height_mm), (4 - turns) % 4);
  pose.covariance_with_camera = Eigen::MatrixXd::Zero(6, parameters);
  summary->bundle.photos = {pose};
  summary->photo_index = {0};
  summary->poses = {{"source", "above"},
                    {"height_mm", height_mm},
                    {"picture_width_mm", height_mm * photo.width_px / focal_px},
                    {"focal_length_from_exif", reported}};
}

}  // namespace glint
