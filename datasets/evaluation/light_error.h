// How far a capture's calibrated light is from a synthetic capture's truth, and from its own σ.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "base/files/json.h"
#include "base/formats/calibration.h"

namespace glint {

// One number of the light: what it is of, its error, its stated standard deviation (0: held).
struct LightCase {
  std::string quantity;  // flash, vignetting, exposure, ambient
  double error = 0, sigma = 0;
  bool WithinThreeSigma() const { return sigma > 0 && error <= 3 * sigma && error >= -3 * sigma; }
};

struct LightErrors {
  double flash_mm = 0;            // length of the position's error in the camera's frame
  double vignetting_percent = 0;  // largest over the picture, of full scale
  double exposure_percent = 0;    // largest over photos, relative to the first
  double ambient_percent = 0;     // largest channel, of the true ambient light
  double power_percent = 0;       // largest channel
  double residual_percent = 0;    // of the calibration's own residuals
  std::vector<LightCase> cases;   // flash x y z (mm); vignetting at r² = 1/4, 1/2, 1; exposure of
                                  // every photo but the first, ambient of every channel (relative)
  std::vector<std::string> held;
};

// `manifest_file`: of calib with --light board. Photos are matched by name; exposures are relative
// to the first photo that both have. Throws UserError where the board told no light.
LightErrors CompareLight(const Calibration& truth, const std::filesystem::path& manifest_file);

Json ToJson(const LightErrors& errors);
LightErrors LightErrorsFromJson(const std::filesystem::path& file, const Json& json);

}  // namespace glint
