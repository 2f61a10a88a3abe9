// What `calib` writes and `rectify` reads: cameras, poses and lights.
#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "base/camera/camera_model.h"
#include "base/camera/rigid3.h"
#include "base/files/json.h"
#include "base/formats/colour_correction.h"

namespace glint {

struct CalibratedPhoto {
  std::string photo;  // relative to the capture's folder
  int camera = 0;     // index into Calibration::cameras
  Rigid3 camera_from_sample;
  Eigen::Vector3d light_in_camera_mm{0, 0, 0};  // flash position in the camera frame
  double exposure = 0;                          // relative to the first photo's; 0: not estimated
  // R, G, B as stored over those of a photo whose white balance is the first photo's.
  Eigen::Vector3d white_balance_rgb{1, 1, 1};
  double rms_px = 0;  // reprojection error of its inlier corners
  int corners = 0, inliers = 0;
  // Standard deviation by which lens, focus and pixel spread a point, as the edges at the board's
  // corners show it; 0: not known.
  double blur_px = 0;
  // The sample's point (x, y) is shown where the pose puts the plane's point registration ·
  // (x, y, 1), millimetres: what pose and lens leave of its place.
  Eigen::Matrix3d registration = Eigen::Matrix3d::Identity();
};

struct Calibration {
  std::vector<Camera> cameras;
  std::vector<CalibratedPhoto> photos;  // accepted flash photographs, in capture order
  Eigen::Vector3d light_rgb{1, 1, 1};  // power, radiance·mm² in units where the sensor clips at 1
  // A response curve beside the manifest by which the photos are to be read, where the board's
  // paper contradicts [radiometry] encoding = "auto"; empty: as capture.toml says.
  std::string tone_curve;
  bool light_power_known = false;  // false: light_rgb is a first guess
  // The camera stood still and the light was moved: each photograph has a light of its own, whose
  // direction is given, and `exposure` and `white_balance_rgb` are its strength and colour.
  bool fixed_camera = false;
  // Standard deviation of the flash's position, where it was estimated: its least certain axis.
  std::optional<double> light_sd_mm;
  // The sample's frame in the board's: the sample may lie higher or lower, and tilted. Poses are
  // the sample's already.
  Rigid3 board_from_sample;
  // From the photographs' colours, in the first one's white balance, to Rec.709, where a chart told
  // it. light_rgb and ambient_rgb are the photographs' own, uncorrected.
  std::optional<ColourCorrection> colour_correction;
  // Irradiance of the room, times the exposure of the first photo; nullopt: not told.
  std::optional<Eigen::Vector3d> ambient_rgb;
};

Json ToJson(const Calibration& calibration);
// Reads the manifest of stage "calib". Throws UserError.
Calibration ReadCalibration(const std::filesystem::path& manifest_file);

}  // namespace glint
