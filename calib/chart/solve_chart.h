// From a chart's readings to a correction of colours.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "base/formats/colour_correction.h"
#include "calib/chart/chart.h"
#include "calib/chart/measure_chart.h"

namespace glint {

// How the flash lights the chart, relative to its middle.
//
// A small light at (x, y, h) over a plane lights its point p with power · h / |p − light|³. Written
// out, |p − light|² is proportional to q(p) = 1 + a·p_x + b·p_y + g·|p|² with a = −2x/D, b = −2y/D,
// g = 1/D, D = x² + y² + h²: three numbers, all 0 for even light. A lens's fall-off adds to g.
// p in half diagonals of the chart (Chart::FromMiddle).
struct ChartLight {
  double a = 0, b = 0, g = 0;
  double At(const Eigen::Vector2d& point) const;  // q^(−3/2); finite wherever the point lies
};

struct PatchColour {
  size_t patch;                      // index in Chart::patches
  Eigen::Vector3d lab;               // corrected, relative to D50, evenly lit
  Eigen::Vector3d held_out_lab;      // corrected by a fit to other patches
  double delta_e = 0, held_out = 0;  // CIEDE2000 from the reference
  double uncorrected = 0;            // with the camera's own colours and the best exposure
};

struct ChartSolution {
  ColourCorrection correction;
  ChartLight light;
  // What a white surface in the chart's middle is stored as, linear; above 1 it would have clipped.
  Eigen::Vector3d white_rgb{1, 1, 1};
  std::vector<PatchColour> patches;  // usable ones, in the chart's order

  double MeanDeltaE() const;
  double WorstDeltaE() const;
  double HeldOutMean() const;
  double HeldOutWorst() const;
  double UncorrectedMean() const;
};

// Fewest usable patches that a model can be fitted to and judged by.
int FewestPatches(ColourModel model);

// Least squares of CIEDE2000's terms over the usable patches, with the fall-off of the light as
// three more unknowns. Held out are the patches 0, 4, 8 … of the usable ones, then 1, 5, 9 …, four
// times in all: each is predicted by a fit to three quarters of the others. Deterministic.
// Precondition: FewestPatches usable readings.
ChartSolution SolveChart(const Chart& chart, const std::vector<PatchReading>& readings,
                         ColourModel model);

// A card's one patch: white balance, a diagonal. Precondition: a usable reading, no channel of 0.
ChartSolution SolveGreyCard(const Chart& chart, const PatchReading& reading);

}  // namespace glint
