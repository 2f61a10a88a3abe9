// What refine found that nobody had said of the photographs: where the environment lighting comes
// from, and where flashes and pictures really were.
#pragma once

#include <string>

#include "pipeline/report/report.h"

namespace glint {

// Empty where nothing was corrected.
std::string CorrectionsSection(const ReportInput& input);

}  // namespace glint
