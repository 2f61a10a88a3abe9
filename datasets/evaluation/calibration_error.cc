#include "datasets/evaluation/calibration_error.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "base/errors/errors.h"

namespace glint {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

// A distance that counts as "not found on the plane at all".
constexpr double kNowhere = std::numeric_limits<double>::infinity();

double RotationBetween_deg(const Eigen::Matrix3d& a, const Eigen::Matrix3d& b) {
  return Eigen::AngleAxisd(a.transpose() * b).angle() * 180 / std::numbers::pi;
}

// Distance on the sample's plane between `corner` and where the estimate puts its true image.
double CornerError_mm(const Camera& true_camera, const CalibratedPhoto& truth,
                      const Camera& estimated_camera, const CalibratedPhoto& estimate,
                      const Vector3d& corner_mm) {
  const Vector2d pixel = ImageFromCamera(true_camera, truth.camera_from_sample * corner_mm);
  const auto normalized = NormalizedFromImage(estimated_camera, pixel);
  if (!normalized) return kNowhere;
  const Rigid3 sample_from_camera = Inverse(estimate.camera_from_sample);
  const Vector3d ray = sample_from_camera.rotation * normalized->homogeneous();
  const Vector3d& centre = sample_from_camera.translation;
  if (!(ray.z() < 0)) return kNowhere;
  return (centre - centre.z() / ray.z() * ray - corner_mm).norm();
}

PhotoPoseError ComparePhoto(const Calibration& truth, const CalibratedPhoto& true_photo,
                            const Calibration& estimate, const CalibratedPhoto& photo,
                            const Vector2d& sample_size_mm, double texels_per_mm) {
  const Rigid3 true_pose = Inverse(true_photo.camera_from_sample);
  const Rigid3 pose = Inverse(photo.camera_from_sample);
  PhotoPoseError error;
  error.photo = photo.photo;
  error.position_percent =
      100 * (pose.translation - true_pose.translation).norm() / true_pose.translation.norm();
  error.rotation_deg = RotationBetween_deg(true_pose.rotation, pose.rotation);
  error.light_mm =
      (pose * photo.light_in_camera_mm - true_pose * true_photo.light_in_camera_mm).norm();
  double squares = 0;
  for (const double sx : {-0.5, 0.5}) {
    for (const double sy : {-0.5, 0.5}) {
      const double distance =
          texels_per_mm *
          CornerError_mm(truth.cameras[true_photo.camera], true_photo,
                         estimate.cameras[photo.camera], photo,
                         Vector3d(sx * sample_size_mm.x(), sy * sample_size_mm.y(), 0));
      squares += distance * distance;
    }
  }
  error.corner_rms_texel = std::sqrt(squares / 4);
  return error;
}

void CompareCamera(const Camera& truth, const Camera& estimate, CalibrationErrors* errors) {
  const auto percent = [](double found, double right) { return 100 * std::abs(found / right - 1); };
  errors->focal_length_percent = std::max(
      {errors->focal_length_percent, percent(estimate.focal_length_x(), truth.focal_length_x()),
       percent(estimate.focal_length_y(), truth.focal_length_y())});
  // The image of the optical axis.
  const Vector3d axis = Vector3d::UnitZ();
  errors->principal_point_px =
      std::max(errors->principal_point_px,
               (ImageFromCamera(estimate, axis) - ImageFromCamera(truth, axis)).norm());
}

void Summarise(CalibrationErrors* errors) {
  double squares = 0;
  for (const PhotoPoseError& photo : errors->photos) {
    errors->largest_position_percent =
        std::max(errors->largest_position_percent, photo.position_percent);
    errors->mean_position_percent += photo.position_percent / errors->photos.size();
    errors->largest_corner_rms_texel =
        std::max(errors->largest_corner_rms_texel, photo.corner_rms_texel);
    squares += photo.corner_rms_texel * photo.corner_rms_texel;
  }
  errors->corner_rms_texel = std::sqrt(squares / errors->photos.size());
}

}  // namespace

CalibrationErrors CompareCalibrations(const Calibration& truth, const Calibration& estimate,
                                      const Vector2d& sample_size_mm, int texels_across) {
  CalibrationErrors errors;
  for (const CalibratedPhoto& true_photo : truth.photos) {
    const auto found =
        std::find_if(estimate.photos.begin(), estimate.photos.end(),
                     [&](const CalibratedPhoto& photo) { return photo.photo == true_photo.photo; });
    if (found == estimate.photos.end()) {
      ++errors.missing_photos;
      continue;
    }
    errors.photos.push_back(ComparePhoto(truth, true_photo, estimate, *found, sample_size_mm,
                                         texels_across / sample_size_mm.x()));
    CompareCamera(truth.cameras[true_photo.camera], estimate.cameras[found->camera], &errors);
  }
  if (errors.photos.empty()) {
    throw UserError(
        "the calibration has none of the ground truth's photographs (the first of them is " +
        (truth.photos.empty() ? "missing" : truth.photos.front().photo) +
        "); give the manifests of one capture");
  }
  Summarise(&errors);
  if (truth.light_power_known && estimate.light_power_known) {
    for (int c = 0; c < 3; ++c) {
      errors.light_power_percent =
          std::max(errors.light_power_percent,
                   100 * std::abs(estimate.light_rgb[c] / truth.light_rgb[c] - 1));
    }
  }
  return errors;
}

Calibration AlignCalibration(const Calibration& truth, const Calibration& estimate,
                             Similarity3* truth_from_estimate) {
  std::vector<Vector3d> from, to;
  for (const CalibratedPhoto& photo : estimate.photos) {
    for (const CalibratedPhoto& true_photo : truth.photos) {
      if (photo.photo != true_photo.photo) continue;
      from.push_back(Inverse(photo.camera_from_sample).translation);
      to.push_back(Inverse(true_photo.camera_from_sample).translation);
    }
  }
  Eigen::Matrix3Xd from_centres(3, from.size()), to_centres(3, to.size());
  for (size_t i = 0; i < from.size(); ++i) {
    from_centres.col(static_cast<long>(i)) = from[i];
    to_centres.col(static_cast<long>(i)) = to[i];
  }
  const auto similarity = AlignPoints(from_centres, to_centres);
  if (!similarity) {
    throw UserError(
        "the calibrations share " + std::to_string(from.size()) +
        " photographs; at least three, not all taken from one straight line, are needed to align "
        "them");
  }
  Calibration aligned = estimate;
  aligned.light_rgb *= similarity->scale * similarity->scale;
  for (CalibratedPhoto& photo : aligned.photos) {
    photo.camera_from_sample = MovedPose(photo.camera_from_sample, *similarity);
    photo.light_in_camera_mm *= similarity->scale;
  }
  if (truth_from_estimate != nullptr) *truth_from_estimate = *similarity;
  return aligned;
}

}  // namespace glint
