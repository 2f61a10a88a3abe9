#include "base/formats/calibration.h"

#include <algorithm>
#include <cmath>

#include "base/errors/errors.h"
#include "base/formats/manifest.h"

namespace glint {
namespace {

std::vector<double> List(const Eigen::Vector3d& v) { return {v.x(), v.y(), v.z()}; }

std::vector<double> RowMajor(const Eigen::Matrix3d& matrix) {
  std::vector<double> values(9);
  for (int i = 0; i < 9; ++i) values[static_cast<size_t>(i)] = matrix(i / 3, i % 3);
  return values;
}

Eigen::Matrix3d FromRowMajor(const std::vector<double>& values) {
  return Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(values.data());
}

Json ToJson(const Rigid3& pose) {
  return {{"rotation", RowMajor(pose.rotation)}, {"translation_mm", List(pose.translation)}};
}

Rigid3 ReadPose(const std::filesystem::path& file, const Json& json, const std::string& name) {
  Rigid3 pose;
  pose.rotation = FromRowMajor(RequireNumbers(file, json, name, "rotation", 9));
  const auto translation = RequireNumbers(file, json, name, "translation_mm", 3);
  pose.translation = Eigen::Map<const Eigen::Vector3d>(translation.data());
  const auto& r = pose.rotation;
  if (!(r * r.transpose()).isIdentity(1e-6) || r.determinant() < 0) {
    throw UserError(file, name + ".rotation", "a matrix that is not a rotation", "run calib again");
  }
  return pose;
}

Camera ReadCamera(const std::filesystem::path& file, const Json& json, const std::string& name) {
  Camera camera;
  const std::string model = RequireString(file, json, name, "model");
  const auto known = CameraModelFromName(model);
  if (!known) {
    throw UserError(file, name + ".model", "'" + model + "'",
                    "use one of " + CameraModelNamesText());
  }
  camera.model = *known;
  camera.width_px = RequireCount(file, json, name, "width_px");
  camera.height_px = RequireCount(file, json, name, "height_px");
  camera.parameters =
      RequireNumbers(file, json, name, "parameters", CameraParameterNames(camera.model).size());
  if (camera.focal_length_x() <= 0 || camera.focal_length_y() <= 0 || camera.width_px < 1 ||
      camera.height_px < 1) {
    throw UserError(file, name, "a focal length or size that is not positive", "run calib again");
  }
  if (json.contains("vignetting")) {
    const auto vignetting = RequireNumbers(file, json, name, "vignetting", 3);
    std::copy(vignetting.begin(), vignetting.end(), camera.vignetting.begin());
  }
  return camera;
}

CalibratedPhoto ReadPhoto(const std::filesystem::path& file, const Json& json,
                          const std::string& name, size_t cameras) {
  CalibratedPhoto photo;
  photo.photo = RequireString(file, json, name, "photo");
  const double camera = RequireNumber(file, json, name, "camera");
  if (camera < 0 || camera >= static_cast<double>(cameras) || camera != std::floor(camera)) {
    throw UserError(file, name + ".camera", std::to_string(camera),
                    "no such camera; run calib again");
  }
  photo.camera = static_cast<int>(camera);
  photo.camera_from_sample = ReadPose(file, RequireField(file, json, name, "camera_from_sample"),
                                      name + ".camera_from_sample");
  if (json.contains("registration")) {
    photo.registration = FromRowMajor(RequireNumbers(file, json, name, "registration", 9));
  }
  const auto light = RequireNumbers(file, json, name, "light_in_camera_mm", 3);
  photo.light_in_camera_mm = Eigen::Map<const Eigen::Vector3d>(light.data());
  if (json.contains("exposure")) {
    photo.exposure = RequireNumber(file, json, name, "exposure");
    if (photo.exposure <= 0) {
      throw UserError(file, name + ".exposure", std::to_string(photo.exposure),
                      "it must be positive; run calib again");
    }
  }
  if (json.contains("white_balance_rgb")) {
    const auto balance = RequireNumbers(file, json, name, "white_balance_rgb", 3);
    photo.white_balance_rgb = Eigen::Map<const Eigen::Vector3d>(balance.data());
    if (photo.white_balance_rgb.minCoeff() <= 0) {
      throw UserError(file, name + ".white_balance_rgb", json["white_balance_rgb"].dump(),
                      "it must be positive; run calib again");
    }
  }
  photo.rms_px = RequireNumber(file, json, name, "rms_px");
  photo.corners = RequireCount(file, json, name, "corners");
  photo.inliers = RequireCount(file, json, name, "inliers");
  photo.blur_px = PositiveNumberIfAny(file, json, name, "blur_px").value_or(0);
  return photo;
}

}  // namespace

Json ToJson(const Calibration& calibration) {
  Json data;
  data["cameras"] = Json::array();
  for (const Camera& camera : calibration.cameras) {
    data["cameras"].push_back({{"model", std::string(CameraModelName(camera.model))},
                               {"width_px", camera.width_px},
                               {"height_px", camera.height_px},
                               {"parameters", camera.parameters},
                               {"vignetting", camera.vignetting}});
  }
  data["light_rgb"] = List(calibration.light_rgb);
  data["light_power_known"] = calibration.light_power_known;
  if (!calibration.tone_curve.empty()) data["tone_curve"] = calibration.tone_curve;
  if (calibration.fixed_camera) data["fixed_camera"] = true;
  if (calibration.light_sd_mm) data["light_sd_mm"] = *calibration.light_sd_mm;
  if (calibration.ambient_rgb) data["ambient_rgb"] = List(*calibration.ambient_rgb);
  if (calibration.colour_correction) {
    data["colour_correction"] = ToJson(*calibration.colour_correction);
  }
  data["board_from_sample"] = ToJson(calibration.board_from_sample);
  data["photos"] = Json::array();
  for (const CalibratedPhoto& photo : calibration.photos) {
    data["photos"].push_back({{"photo", photo.photo},
                              {"camera", photo.camera},
                              {"camera_from_sample", ToJson(photo.camera_from_sample)},
                              {"registration", RowMajor(photo.registration)},
                              {"light_in_camera_mm", List(photo.light_in_camera_mm)},
                              {"rms_px", photo.rms_px},
                              {"corners", photo.corners},
                              {"inliers", photo.inliers}});
    if (photo.blur_px > 0) data["photos"].back()["blur_px"] = photo.blur_px;
    if (photo.exposure > 0) data["photos"].back()["exposure"] = photo.exposure;
    if (photo.white_balance_rgb != Eigen::Vector3d::Ones()) {
      data["photos"].back()["white_balance_rgb"] = List(photo.white_balance_rgb);
    }
  }
  return data;
}

namespace {

const Json& RequireList(const std::filesystem::path& file, const Json& data,
                        const std::string& field) {
  const Json& list = RequireField(file, data, "data", field);
  if (!list.is_array()) {
    throw UserError(file, "data." + field, list.dump(),
                    "a list is expected; run glint-calib again");
  }
  return list;
}

}  // namespace

Calibration ReadCalibration(const std::filesystem::path& manifest_file) {
  const Manifest manifest = ReadManifest(manifest_file, "calib");
  VerifyOutputs(manifest_file, manifest);
  Calibration calibration;
  const Json& cameras = RequireList(manifest_file, manifest.data, "cameras");
  for (size_t i = 0; i < cameras.size(); ++i) {
    calibration.cameras.push_back(
        ReadCamera(manifest_file, cameras[i], "data.cameras[" + std::to_string(i) + "]"));
  }
  const auto light = RequireNumbers(manifest_file, manifest.data, "data", "light_rgb", 3);
  calibration.light_rgb = Eigen::Map<const Eigen::Vector3d>(light.data());
  calibration.light_power_known =
      RequireBool(manifest_file, manifest.data, "data", "light_power_known");
  if (manifest.data.contains("tone_curve")) {
    calibration.tone_curve = RequireString(manifest_file, manifest.data, "data", "tone_curve");
    const std::filesystem::path name = calibration.tone_curve;
    if (name.filename() != name || name.extension() != ".json") {
      throw UserError(manifest_file, "data.tone_curve", "'" + calibration.tone_curve + "'",
                      "the name of a .json file beside the manifest is expected; run calib again");
    }
  }
  calibration.fixed_camera = manifest.data.contains("fixed_camera") &&
                             RequireBool(manifest_file, manifest.data, "data", "fixed_camera");
  calibration.light_sd_mm =
      PositiveNumberIfAny(manifest_file, manifest.data, "data", "light_sd_mm");
  if (manifest.data.contains("ambient_rgb")) {
    const auto ambient = RequireNumbers(manifest_file, manifest.data, "data", "ambient_rgb", 3);
    calibration.ambient_rgb = Eigen::Map<const Eigen::Vector3d>(ambient.data());
  }
  if (manifest.data.contains("colour_correction")) {
    calibration.colour_correction = ReadColourCorrection(
        manifest_file, manifest.data["colour_correction"], "data.colour_correction");
  }
  if (manifest.data.contains("board_from_sample")) {
    calibration.board_from_sample =
        ReadPose(manifest_file, manifest.data["board_from_sample"], "data.board_from_sample");
  }
  const Json& photos = RequireList(manifest_file, manifest.data, "photos");
  for (size_t i = 0; i < photos.size(); ++i) {
    calibration.photos.push_back(ReadPhoto(manifest_file, photos[i],
                                           "data.photos[" + std::to_string(i) + "]",
                                           calibration.cameras.size()));
  }
  return calibration;
}

}  // namespace glint
