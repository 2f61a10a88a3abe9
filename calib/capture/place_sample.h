// The sample's own plane, above or below the board's, and what poses and lens leave of the
// photographs' displacement.
#pragma once

#include <string>

#include "calib/capture/calibrate_capture.h"

namespace glint {

// Finds the plane from the photographs (registration/register_sample.h) and moves the calibration's
// poses into the sample's frame: the sample lies at z = 0 from here on. Needs calibration.photos.
void PlaceSample(const Capture& capture, const CalibOptions& options, int threads,
                 CalibSummary* summary);

// For the report.
Json PlacementMetrics(const CalibSummary& summary);
// "sample lies 3.1 ± 0.1 mm above the board, tilted by 0.4°"; "" where nothing was sought.
std::string PlacementText(const CalibSummary& summary);

}  // namespace glint
