#include "datasets/evaluation/light_error.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "base/errors/errors.h"
#include "base/formats/manifest.h"

namespace glint {
namespace {

namespace fs = std::filesystem;
using Eigen::Vector3d;

struct Values {
  std::vector<double> value, sigma;
};

Values ReadValues(const fs::path& file, const Json& json, const std::string& field) {
  const std::string name = "metrics.light.board";
  const Json& object = RequireField(file, json, name, field);
  return {RequireNumbers(file, object, name + "." + field, "value", 3),
          RequireNumbers(file, object, name + "." + field, "sigma", 3)};
}

double Polynomial(const std::array<double, 3>& v, double r2) {
  return 1 + r2 * (v[0] + r2 * (v[1] + r2 * v[2]));
}

void CompareVignetting(const fs::path& file, const Camera& truth, const Camera& estimate,
                       const Json& board, LightErrors* errors) {
  for (int i = 0; i <= 100; ++i) {
    const double r2 = i / 100.0;
    const double error = Polynomial(estimate.vignetting, r2) - Polynomial(truth.vignetting, r2);
    errors->vignetting_percent = std::max(errors->vignetting_percent, 100 * std::abs(error));
  }
  const Json& all = RequireField(file, board, "metrics.light.board", "vignetting");
  const auto numbers = RequireNumbers(file, all.at(0), "vignetting[0]", "covariance", 9);
  const Eigen::Map<const Eigen::Matrix3d> covariance(numbers.data());
  for (const double r2 : {0.25, 0.5, 1.0}) {
    const Vector3d powers(r2, r2 * r2, r2 * r2 * r2);
    errors->cases.push_back({"vignetting",
                             Polynomial(estimate.vignetting, r2) - Polynomial(truth.vignetting, r2),
                             std::sqrt(std::max(0.0, powers.dot(covariance * powers)))});
  }
}

const CalibratedPhoto* Find(const Calibration& calibration, const std::string& photo) {
  for (const CalibratedPhoto& candidate : calibration.photos) {
    if (candidate.photo == photo) return &candidate;
  }
  return nullptr;
}

void CompareExposures(const fs::path& file, const Calibration& truth, const Calibration& estimate,
                      const Json& board, LightErrors* errors) {
  const CalibratedPhoto& first = estimate.photos.front();
  const CalibratedPhoto* true_first = Find(truth, first.photo);
  if (true_first == nullptr) return;
  for (const Json& entry : RequireField(file, board, "metrics.light.board", "photos")) {
    const std::string name = RequireString(file, entry, "photos[]", "photo");
    const CalibratedPhoto* photo = Find(estimate, name);
    const CalibratedPhoto* true_photo = Find(truth, name);
    if (photo == nullptr || true_photo == nullptr || name == first.photo) continue;
    const double right = true_photo->exposure / true_first->exposure;
    const double found = photo->exposure / first.exposure;
    const Json& exposure = RequireField(file, entry, "photos[]", "exposure");
    const double sigma = RequireNumber(file, exposure, "exposure", "sigma") /
                         std::max(1e-12, RequireNumber(file, exposure, "exposure", "value"));
    errors->cases.push_back({"exposure", found / right - 1, sigma});
    errors->exposure_percent =
        std::max(errors->exposure_percent, 100 * std::abs(found / right - 1));
  }
}

void CompareAmbient(const fs::path& file, const Calibration& truth, const Calibration& estimate,
                    const Json& board, LightErrors* errors) {
  for (int c = 0; c < 3; ++c) {
    errors->power_percent = std::max(
        errors->power_percent, 100 * std::abs(estimate.light_rgb[c] / truth.light_rgb[c] - 1));
  }
  if (!truth.ambient_rgb || !estimate.ambient_rgb || truth.ambient_rgb->minCoeff() <= 0) return;
  const Values ambient = ReadValues(file, board, "ambient_rgb");
  for (int c = 0; c < 3; ++c) {
    const double right = (*truth.ambient_rgb)[c];
    const double error = (*estimate.ambient_rgb)[c] / right - 1;
    errors->cases.push_back({"ambient", error, ambient.sigma[c] / right});
    errors->ambient_percent = std::max(errors->ambient_percent, 100 * std::abs(error));
  }
}

}  // namespace

LightErrors CompareLight(const Calibration& truth, const fs::path& manifest_file) {
  const Manifest manifest = ReadManifest(manifest_file, "calib");
  const Calibration estimate = ReadCalibration(manifest_file);
  const Json& light = RequireField(manifest_file, manifest.metrics, "metrics", "light");
  if (!light.contains("board")) {
    throw UserError(manifest_file, "metrics.light", "no light measured from the board",
                    "run glint-calib with --light board on photographs with a board");
  }
  const Json& board = light["board"];
  LightErrors errors;
  errors.residual_percent =
      RequireNumber(manifest_file, board, "metrics.light.board", "residual_rms_percent");
  const Values flash = ReadValues(manifest_file, board, "flash_in_camera_mm");
  const Vector3d right = truth.photos.front().light_in_camera_mm;
  double squares = 0;
  for (int i = 0; i < 3; ++i) {
    const double error = flash.value[i] - right[i];
    errors.cases.push_back({"flash", error, flash.sigma[i]});
    squares += error * error;
  }
  errors.flash_mm = std::sqrt(squares);
  CompareVignetting(manifest_file, truth.cameras.front(), estimate.cameras.front(), board, &errors);
  CompareExposures(manifest_file, truth, estimate, board, &errors);
  CompareAmbient(manifest_file, truth, estimate, board, &errors);
  for (const Json& word : RequireField(manifest_file, board, "metrics.light.board", "held")) {
    errors.held.push_back(word.get<std::string>());
  }
  return errors;
}

Json ToJson(const LightErrors& errors) {
  Json json = {{"flash_mm", errors.flash_mm},
               {"vignetting_percent", errors.vignetting_percent},
               {"exposure_percent", errors.exposure_percent},
               {"ambient_percent", errors.ambient_percent},
               {"power_percent", errors.power_percent},
               {"residual_percent", errors.residual_percent},
               {"held", errors.held},
               {"cases", Json::array()}};
  for (const LightCase& one : errors.cases) {
    json["cases"].push_back(
        {{"quantity", one.quantity}, {"error", one.error}, {"sigma", one.sigma}});
  }
  return json;
}

LightErrors LightErrorsFromJson(const fs::path& file, const Json& json) {
  LightErrors errors;
  const auto number = [&](const char* field) { return RequireNumber(file, json, "light", field); };
  errors.flash_mm = number("flash_mm");
  errors.vignetting_percent = number("vignetting_percent");
  errors.exposure_percent = number("exposure_percent");
  errors.ambient_percent = number("ambient_percent");
  errors.power_percent = number("power_percent");
  errors.residual_percent = number("residual_percent");
  for (const Json& one : RequireField(file, json, "light", "cases")) {
    errors.cases.push_back({RequireString(file, one, "cases[]", "quantity"),
                            RequireNumber(file, one, "cases[]", "error"),
                            RequireNumber(file, one, "cases[]", "sigma")});
  }
  for (const Json& word : RequireField(file, json, "light", "held")) {
    errors.held.push_back(word.get<std::string>());
  }
  return errors;
}

}  // namespace glint
