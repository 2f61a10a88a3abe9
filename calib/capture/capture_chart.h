// The colours of a capture by the chart or grey card that [chart] names.
#pragma once

#include <vector>

#include "calib/capture/calibrate_capture.h"

namespace glint {

// Reads the chart as rectify reads photographs (encoding, tone curve, profile) and fills
// summary->chart and calibration.colour_correction; does nothing without [chart]. Needs the
// calibrated photographs and their light.
//
// Which white: the chart's, if its photograph is one of the calibrated ones, whose white balances
// are known relative to each other. A photograph of its own may have been balanced differently;
// where its white is farther from the board's paper than any white paper is from neutral (10 %
// between channels), the paper's white counts, and that is said. A
// grey card, which tells nothing but white, counts all the same.
// Throws UserError: no such chart in the photograph, too few usable patches, or colours of which
// held-out patches are off by more than 10 ΔE.
void CorrectColours(const Capture& capture, CalibSummary* summary);

// Takes a chart's photograph in which no board was found out of `photos`: it is none of the sample.
void LeaveOutChartPhoto(const Capture& capture, std::vector<DetectedPhoto>* photos);
// The same where no board is looked for and one photograph shows the sample.
Capture WithoutChartPhoto(const Capture& capture);

}  // namespace glint
