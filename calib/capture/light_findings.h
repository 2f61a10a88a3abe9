// What the board's light says of the photographs themselves, in words that a person can act on.
#pragma once

#include <string>
#include <vector>

#include "calib/capture/calibrate_capture.h"

namespace glint {

// Photographs' pixels that were turned, exposures, white balance, tone curve and flash that
// contradict EXIF, [radiometry] or [light], each with its likely cause and remedy. Turned pixels
// alone where the board did not tell the light.
std::vector<std::string> LightFindings(const Capture& capture, const CalibSummary& summary);

// Why a photograph that contradicts all others is left out; "": it stays. `flash_off`: EXIF
// reports that no flash fired, though it did in most of the others.
std::string ContradictionOf(const LightEstimate& light, const LightOfPhoto& photo, bool flash_off);

}  // namespace glint
