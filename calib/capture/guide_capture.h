// From a calibration to what guidance judges; and a quick look at a capture.
#pragma once

#include "base/programs/program.h"
#include "calib/capture/calibrate_capture.h"
#include "calib/guidance/verdict.h"

namespace glint {

// Of a summary with at least one calibrated photograph.
GuidanceInput GuidanceInputOf(const Capture& capture, const CalibSummary& summary,
                              bool focal_assumed);

// Reads the photographs at reduced size, calibrates and judges; writes nothing. Where the
// photographs do not determine the focal length, EXIF's is taken, or a phone's. Throws UserError
// where no photograph shows the board, or files cannot be read.
CalibSummary CheckCapture(const Capture& capture, const CalibOptions& options,
                          const CommonOptions& common);

}  // namespace glint
