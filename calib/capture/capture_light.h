// The light of a calibrated capture: from the board, or as capture.toml and EXIF tell it.
#pragma once

#include "calib/capture/calibrate_capture.h"

namespace glint {

// Fills in `calibration`: positions of the flash, power, exposures, ambient light, the cameras'
// vignetting; and in the summary how they were found. Needs calibration.photos and the bundle.
void FillLight(const Capture& capture, const CalibOptions& options, CalibSummary* summary);

// Writes light_residuals.png through the stage, where the board told the light.
void WriteLightPicture(const CalibSummary& summary, Stage* stage);

// What a person can do where the light is uncertain; empty: nothing. One sentence each.
std::vector<std::string> LightAdvice(const CalibSummary& summary);

// Parts of the report (capture_light_report.cc).
Json LightMetrics(const CalibSummary& summary);
std::string LightText(const CalibSummary& summary);

}  // namespace glint
