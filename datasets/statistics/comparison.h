// Two populations of materials side by side: how far apart each statistic lies.
#pragma once

#include <string>
#include <vector>

#include "datasets/statistics/population.h"

namespace glint {

// One compared statistic.
struct Distance {
  std::string group;  // "histogram", "spectrum" or "trait"
  std::string name;
  double ks = 0;           // Kolmogorov–Smirnov, 0 … 1
  double wasserstein = 0;  // in the statistic's unit; decades for spectra
  double expected_ks = 0;  // what populations of these sizes show when they are alike; 0: not known
  double quantiles[2][3] = {};  // of real and generated: 10, 50 and 90 %
  bool judged = true;           // enters the means
};

struct Comparison {
  Population real, generated;
  std::vector<Distance> distances;

  // Mean Kolmogorov–Smirnov distance of the judged statistics of a group; of all for "".
  double MeanDistance(const std::string& group) const;
  std::string BriefReport() const;
};

// Histograms: of the mean material, so that each counts the same. Spectra: the mean, over bands
// that both hold, of the distance between the materials' log power. Traits: of the materials.
Comparison Compare(Population real, Population generated);

}  // namespace glint
