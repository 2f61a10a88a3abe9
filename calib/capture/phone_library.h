// Intrinsics of a phone that was calibrated before.
//
// A library is a folder of manifests of stage calib, copied under any name: a person who has a good
// calibration keeps its manifest.json there, and later captures of the same camera need no more
// than its poses. A camera is told by EXIF's make and model, its 35 mm focal length and the size
// of the stored picture.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "base/camera/camera_model.h"

namespace glint {

struct PhoneIdentity {
  std::string exif_camera;  // make and model
  double focal_length_35mm = 0;
  int width_px = 0, height_px = 0;  // of the stored picture
};

struct KnownPhone {
  std::filesystem::path file;
  Camera camera;
  double relative_focal_sigma = 0;  // as that calibration had it
};

// The library's manifests (*.json), sorted. Throws UserError when the folder does not exist.
std::vector<std::filesystem::path> LibraryFiles(const std::filesystem::path& folder);

// The phone's camera with the smallest uncertainty of the focal length; nullopt: not in the
// library, or EXIF does not name the phone. Throws UserError for files that are no manifests.
std::optional<KnownPhone> FindPhone(const std::filesystem::path& folder,
                                    const PhoneIdentity& phone);

}  // namespace glint
