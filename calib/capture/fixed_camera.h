// A camera that stands still above the sample while the light is moved: nothing to solve for but
// how bright the light was. docs/rti.md.
#pragma once

#include "calib/capture/calibrate_capture.h"

namespace glint {

// Fills photos, calibration, rejected, poses, lamps and guidance of `summary`. The camera looks
// straight down at the picture's middle; the scale comes from [poses] picture_width_mm or
// points_px, else the picture's width shows the sample's; directions from [lights]. Throws
// UserError: photographs of several sizes, lights that do not fit, a sample that the picture does
// not show.
void CalibrateFixedCamera(const Capture& capture, const CalibOptions& options, int threads,
                          CalibSummary* summary);

}  // namespace glint
