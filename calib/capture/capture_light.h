// The light of a calibrated capture: from the board, or as capture.toml and EXIF tell it.
#pragma once

#include <optional>

#include "base/linearize/response_curve.h"
#include "calib/capture/calibrate_capture.h"

namespace glint {

// The light where the board is to tell it; else, nothing known. Needs the bundle.
LightEstimate EstimateBoardLight(const Capture& capture, const CalibOptions& options,
                                 const CalibSummary& summary);

// Puts right what summary->light says of photographs: pixels that were turned, photographs that
// contradict all others. True: views changed, and the bundle is to be adjusted again.
bool FollowLight(CalibSummary* summary);

// Fills in `calibration`: positions of the flash, power, exposures, ambient light, the cameras'
// vignetting; and in the summary how they were found. Needs calibration.photos and the bundle.
void FillLight(const Capture& capture, const CalibOptions& options, CalibSummary* summary);

// The tone curve that the paper told, as a response curve; nullopt: photographs are read as
// [radiometry] encoding says.
std::optional<ResponseCurve> ToneCurveOf(const Capture& capture, const CalibSummary& summary);

// Writes light_residuals.png through the stage, where the board told the light.
void WriteLightPicture(const CalibSummary& summary, Stage* stage);

// What a person can do where the light is uncertain; empty: nothing. One sentence each.
std::vector<std::string> LightAdvice(const CalibSummary& summary);

// Parts of the report (capture_light_report.cc).
Json LightMetrics(const CalibSummary& summary);
std::string LightText(const CalibSummary& summary);

}  // namespace glint
