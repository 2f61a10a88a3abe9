// A chart as it was measured, beside what it should be.
#pragma once

#include "base/images/image.h"
#include "calib/chart/solve_chart.h"

namespace glint {

// sRGB on [0, 1]. Each patch: the corrected colour, evenly lit, and in its middle the reference.
// Patches that were not used show the reference alone, as a frame.
Image ChartPicture(const Chart& chart, const ChartSolution& solution);

}  // namespace glint
