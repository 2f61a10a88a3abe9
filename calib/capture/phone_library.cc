#include "calib/capture/phone_library.h"

#include <algorithm>
#include <cmath>

#include "base/errors/errors.h"
#include "base/formats/manifest.h"

namespace glint {
namespace {

// metrics.cameras[i] of stage calib: the camera of stored pictures, with standard deviations.
std::optional<KnownPhone> ReadPhone(const std::filesystem::path& file, const Json& json,
                                    const std::string& name, const PhoneIdentity& phone) {
  if (!json.contains("exif_camera")) return std::nullopt;  // of an older program
  const auto size = RequireNumbers(file, json, name, "size_px", 2);
  if (RequireString(file, json, name, "exif_camera") != phone.exif_camera ||
      std::abs(RequireNumber(file, json, name, "focal_length_35mm") - phone.focal_length_35mm) >
          0.05 ||
      size[0] != phone.width_px || size[1] != phone.height_px) {
    return std::nullopt;
  }
  const std::string model = RequireString(file, json, name, "model");
  const auto known = CameraModelFromName(model);
  if (!known) throw UserError(file, name + ".model", "'" + model + "'", "run calib again");
  KnownPhone found{file, {*known, phone.width_px, phone.height_px, {}}, 0};
  const Json& parameters = RequireField(file, json, name, "parameters");
  for (const std::string& parameter : CameraParameterNames(*known)) {
    const std::string at = name + ".parameters." + parameter;
    const Json& entry = RequireField(file, parameters, name + ".parameters", parameter);
    found.camera.parameters.push_back(RequireNumber(file, entry, at, "value"));
    if (found.camera.parameters.size() == 1) {
      found.relative_focal_sigma = RequireNumber(file, entry, at, "sigma");
    }
  }
  if (!(found.camera.focal_length_x() > 0)) {
    throw UserError(file, name + ".parameters", "a focal length that is not positive",
                    "run calib again");
  }
  if (found.relative_focal_sigma == 0) return std::nullopt;  // was itself taken from elsewhere
  found.relative_focal_sigma /= found.camera.focal_length_x();
  return found;
}

}  // namespace

std::vector<std::filesystem::path> LibraryFiles(const std::filesystem::path& folder) {
  if (!std::filesystem::is_directory(folder)) {
    throw UserError(folder, "library", "no such folder",
                    "make it, and copy the manifest.json of a good calibration into it");
  }
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    if (entry.is_regular_file() && entry.path().extension() == ".json") {
      files.push_back(entry.path());
    }
  }
  std::sort(files.begin(), files.end());
  return files;
}

std::optional<KnownPhone> FindPhone(const std::filesystem::path& folder,
                                    const PhoneIdentity& phone) {
  std::optional<KnownPhone> best;
  if (phone.exif_camera.empty()) return best;
  for (const std::filesystem::path& file : LibraryFiles(folder)) {
    const Manifest manifest = ReadManifest(file, "calib");
    const Json& cameras = RequireField(file, manifest.metrics, "metrics", "cameras");
    for (size_t i = 0; i < cameras.size(); ++i) {
      const auto found =
          ReadPhone(file, cameras[i], "metrics.cameras[" + std::to_string(i) + "]", phone);
      if (!found) continue;
      if (!best || found->relative_focal_sigma < best->relative_focal_sigma) best = found;
    }
  }
  return best;
}

}  // namespace glint
