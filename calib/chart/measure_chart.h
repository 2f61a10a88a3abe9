// The patches of a chart as a photograph shows them.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "base/linearize/linear_photo.h"
#include "calib/chart/chart.h"
#include "calib/chart/find_chart.h"

namespace glint {

struct PatchReading {
  Eigen::Vector3d rgb{0, 0, 0};  // linear radiance as LinearPhoto gives it; 1: the photo clips
  int pixels = 0;
  bool clipped = false;  // more pixels have a channel at an end than the mean leaves out
  bool inside = true;    // of the photograph
  bool usable() const { return inside && !clipped && pixels > 0; }
};

// One for each patch, in the chart's order. Read is the square in the patch's middle with half its
// side, which leaves a quarter of a patch for corners that are off; of its pixels the mean of the
// middle half of the values, channel by channel: dust, scratches and a highlight's rim do not
// count, and eight-bit steps average out.
std::vector<PatchReading> MeasureChart(const LinearPhoto& photo, const Chart& chart,
                                       const ChartCorners& corners_px);

}  // namespace glint
