// What Gao et al. 2019 report: means over their 42 SVBRDFs at 256². Absolute figures of different
// materials cannot be compared; how methods and conditions compare can.
#pragma once

#include <optional>
#include <string>

#include "datasets/evaluation/experiment_result.h"

namespace glint {

// Table 1; `method` is classic, latent or refined.
std::optional<Table1Row> PaperTable1(int count, const std::string& method);

// Robustness of refined maps at N = 20 (their table 2). One of the two is 0, of 1, 5 and 10; both
// 0: undisturbed.
std::optional<PaperFigures> PaperTable2(double light_off_deg, double environment_percent);

}  // namespace glint
