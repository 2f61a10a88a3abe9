#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "calib/capture/calibrate_capture.h"
#include "calib/capture/capture_light.h"
#include "calib/capture/place_sample.h"

namespace glint {
namespace {

std::vector<double> List(const Eigen::Vector2d& v) { return {v.x(), v.y()}; }
std::vector<double> List(const Eigen::Vector3d& v) { return {v.x(), v.y(), v.z()}; }

// JSON has no infinity: what cannot be told is null.
Json Number(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

Json CameraMetrics(const CameraEstimate& estimate) {
  Json json;
  json["model"] = std::string(CameraModelName(estimate.camera.model));
  json["size_px"] = {estimate.camera.width_px, estimate.camera.height_px};
  json["photos"] = estimate.photos;
  const auto& names = CameraParameterNames(estimate.camera.model);
  for (size_t i = 0; i < names.size(); ++i) {
    json["parameters"][names[i]] = {{"value", estimate.camera.parameters[i]},
                                    {"sigma", Number(estimate.sigma[i])}};
  }
  json["covariance"] = Json::array();
  for (long row = 0; row < estimate.covariance.rows(); ++row) {
    Json values = Json::array();
    for (long column = 0; column < estimate.covariance.cols(); ++column) {
      values.push_back(Number(estimate.covariance(row, column)));
    }
    json["covariance"].push_back(values);
  }
  return json;
}

Json PhotoMetrics(const CalibSummary& summary, size_t index) {
  const PhotoEstimate& estimate = summary.bundle.photos[index];
  const size_t photo = summary.photo_index[index];
  const Eigen::Vector3d position = Inverse(estimate.camera_from_sample).translation;
  Json json;
  json["photo"] = estimate.name;
  json["for_intrinsics_only"] = summary.photos[photo].board_photo;
  json["camera"] = estimate.camera;
  json["quarter_turns"] = summary.groups.turns[photo];
  json["corners"] = estimate.corners.size();
  json["inliers"] = estimate.inliers();
  json["rms_px"] = estimate.rms_px;
  json["tilt_deg"] = estimate.tilt_deg;
  json["position_in_sample_mm"] = List(position);
  json["sigma_position_mm"] = Number(estimate.sigma_position_mm);
  json["sigma_rotation_deg"] = Number(estimate.sigma_rotation_deg);
  json["rejected_corners"] = Json::array();
  for (const CornerResidual& corner : estimate.corners) {
    if (corner.inlier) continue;
    json["rejected_corners"].push_back({{"id", corner.id},
                                        {"point_px", List(corner.point_px)},
                                        {"residual_px", List(corner.residual_px)}});
  }
  return json;
}

Json TriageOf(const CalibSummary& summary) {
  std::vector<PhotoMeasures> measures;
  for (const DetectedPhoto& photo : summary.photos) measures.push_back(photo.measures);
  return ToJson(measures, summary.remarks);
}

}  // namespace

Json MetricsOf(const CalibSummary& summary) {
  Json metrics;
  metrics["rms_px"] = summary.bundle.rms_px;
  metrics["corners"] = summary.bundle.corners;
  metrics["inliers"] = summary.bundle.inliers;
  metrics["cameras"] = Json::array();
  for (size_t c = 0; c < summary.bundle.cameras.size(); ++c) {
    metrics["cameras"].push_back(CameraMetrics(summary.bundle.cameras[c]));
    const DetectedPhoto& photo = summary.photos[summary.groups.groups[c].photos[0]];
    metrics["cameras"].back()["exif_camera"] = photo.camera_model;
    metrics["cameras"].back()["focal_length_35mm"] = photo.focal_length_35mm;
  }
  metrics["photos"] = Json::array();
  for (size_t i = 0; i < summary.bundle.photos.size(); ++i) {
    if (!summary.bundle.photos[i].rejected.empty()) continue;
    metrics["photos"].push_back(PhotoMetrics(summary, i));
  }
  metrics["rejected_photos"] = Json::array();
  for (const RejectedPhoto& photo : summary.rejected) {
    metrics["rejected_photos"].push_back({{"photo", photo.name}, {"reason", photo.reason}});
  }
  if (summary.from_board()) AddTrustMetrics(summary.bundle, summary.trust, &metrics);
  metrics["triage"] = TriageOf(summary);
  metrics["light"] = LightMetrics(summary);
  metrics["sample_plane"] = PlacementMetrics(summary);
  metrics["guidance"] = ToJson(summary.guidance);
  if (summary.chart) metrics["chart"] = ToJson(*summary.chart);
  if (!summary.poses.is_null()) metrics["poses"] = summary.poses;
  return metrics;
}

Json ResidualsOf(const CalibSummary& summary) {
  Json json;
  json["about"] =
      "per photo [corner id, x_px, y_px, residual x, residual y, inlier]: seen - predicted, in the "
      "stored picture; the centre of the top-left pixel is (0.5, 0.5)";
  json["triage"] = TriageOf(summary);
  json["photos"] = Json::object();
  for (const PhotoEstimate& photo : summary.bundle.photos) {
    Json corners = Json::array();
    for (const CornerResidual& c : photo.corners) {
      corners.push_back({c.id, c.point_px.x(), c.point_px.y(), c.residual_px.x(), c.residual_px.y(),
                         c.inlier && photo.rejected.empty()});
    }
    json["photos"][photo.name] = corners;
  }
  if (summary.from_board()) AddTrustResiduals(summary.bundle, summary.trust, &json);
  return json;
}

// What COLMAP's model gave; "" where the board gave the poses.
std::string PosesText(const Json& poses) {
  if (poses.is_null()) return "";
  if (poses["source"] == "fixed camera") {
    return fmt::format("camera fixed {:.4g} mm above the sample{}, the picture {:.4g} mm across\n",
                       poses["camera_mm"].get<double>(),
                       poses["camera_distance_known"].get<bool>() ? "" : " (assumed)",
                       poses["picture_width_mm"].get<double>());
  }
  if (poses["source"] == "above") {
    return fmt::format("pose as stated: from {:.4g} mm straight above, {:.4g} mm across\n",
                       poses["height_mm"].get<double>(), poses["picture_width_mm"].get<double>());
  }
  return fmt::format(
      "poses from COLMAP: {} of {} images; plane through {} of {} points ({:.0f} % by weight), "
      "{:.3f} mm RMS; scale from {}, {:.5g} mm per unit\n",
      poses["images_used"].get<size_t>(), poses["images"].get<size_t>(),
      poses["plane_inliers"].get<size_t>(), poses["plane_points"].get<size_t>(),
      100 * poses["plane_share"].get<double>(), poses["plane_rms_mm"].get<double>(),
      poses["scale_from"].get<std::string>(), poses["mm_per_unit"].get<double>());
}

std::string TextOf(const CalibSummary& summary) {
  const size_t used = summary.calibration.photos.size();
  std::string text =
      summary.calibration.fixed_camera
          ? fmt::format("calib: {} of {} photographs\n", used, used + summary.rejected.size())
          : "calib: " + summary.bundle.BriefReport();
  text += PosesText(summary.poses);
  for (size_t i = 0; i < summary.bundle.photos.size(); ++i) {
    const PhotoEstimate& photo = summary.bundle.photos[i];
    if (!photo.rejected.empty()) continue;
    const std::string sigma = std::isfinite(photo.sigma_position_mm)
                                  ? fmt::format(" ± {:.2f}", photo.sigma_position_mm)
                                  : "";
    text += fmt::format(
        "  {:<28} {:3} of {:3} corners  {:.3f} px  tilt {:4.1f} deg  camera at {:.0f} mm{}{}\n",
        photo.name, photo.inliers(), photo.corners.size(), photo.rms_px, photo.tilt_deg,
        photo.camera_from_sample.translation.norm(), sigma,
        summary.photos[summary.photo_index[i]].board_photo ? "  (intrinsics only)" : "");
  }
  for (const RejectedPhoto& photo : summary.rejected) {
    text += fmt::format("  left out: {}: {}\n", photo.name, photo.reason);
  }
  if (summary.from_board()) text += TextOf(summary.bundle, summary.trust);
  if (summary.chart) text += TextOf(*summary.chart);
  return text + LightText(summary) + PlacementText(summary) + TextOf(summary.guidance);
}

std::string BriefTextOf(const CalibSummary& summary) {
  const BundleResult& bundle = summary.bundle;
  std::string text = fmt::format("{} of {} photographs", summary.calibration.photos.size(),
                                 summary.calibration.photos.size() + summary.rejected.size());
  if (!summary.calibration.fixed_camera) {
    text += fmt::format(", reprojection error {:.3g} px", bundle.rms_px);
  }
  for (const RejectedPhoto& photo : summary.rejected) {
    text += fmt::format("\n  left out: {}: {}", photo.name, photo.reason);
  }
  std::string guidance = PlacementText(summary) + TextOf(summary.guidance);
  if (summary.chart) guidance = TextOf(*summary.chart) + guidance;
  if (guidance.ends_with("\n")) guidance.pop_back();
  return text + "\n  " + guidance;
}

}  // namespace glint
