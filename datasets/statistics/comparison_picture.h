// A comparison as one picture of small panels, real materials in orange, generated in blue.
#pragma once

#include "base/images/image.h"
#include "datasets/statistics/comparison.h"

namespace glint {

// Histograms; spectra (median, 10 and 90 % of the materials' log power over log frequency);
// cumulative distributions of the traits. Each panel names its Kolmogorov–Smirnov distance.
Image DrawComparison(const Comparison& comparison);

}  // namespace glint
