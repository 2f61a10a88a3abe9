// A comparison on disk.
#pragma once

#include <filesystem>

#include "base/files/json.h"
#include "datasets/statistics/comparison.h"

namespace glint {

// Distances, mean histograms and spectra's quantiles of both sides.
Json ComparisonJson(const Comparison& comparison);

// One line a material of either side: side, material, every trait (empty where undefined).
std::string TraitCsv(const Comparison& comparison);

// Writes statistics.json, statistics.csv and statistics.png into `folder`, which is made when it is
// missing. Throws EnvironmentError.
void WriteComparison(const std::filesystem::path& folder, const Comparison& comparison);

}  // namespace glint
