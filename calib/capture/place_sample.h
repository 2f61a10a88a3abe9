// The sample's own plane, above or below the board's, and what poses and lens leave of the
// photographs' displacement.
#pragma once

#include <string>

#include "calib/capture/calibrate_capture.h"

namespace glint {

// Finds the plane from the photographs (registration/register_sample.h), from cameras and poses
// alone. `detected` holds their pictures of the sample.
SampleRegistration FindSamplePlane(const Capture& capture, const CalibOptions& options,
                                   const Calibration& calibration,
                                   const std::vector<DetectedPhoto>& detected, int threads);

// Leaves out photographs of another sample than most show. Returns whether it did.
bool LeaveOutOtherSamples(CalibSummary* summary);
// The same in words, of photographs that stay; "" where all show one sample.
std::string OtherSamplesInWords(const CalibSummary& summary);
// "the sample was moved …"; "" where it was not.
std::string MovesInWords(const SampleRegistration& registration, const Calibration& calibration);

// Moves the calibration's poses into the sample's frame: the sample lies at z = 0 from here on.
void PlaceSample(const SampleRegistration& registration, Calibration* calibration);

// For the report.
Json PlacementMetrics(const CalibSummary& summary);
// "sample lies 3.1 ± 0.1 mm above the board, tilted by 0.4°"; "" where nothing was sought.
std::string PlacementText(const CalibSummary& summary);

}  // namespace glint
