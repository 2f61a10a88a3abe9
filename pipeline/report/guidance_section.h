// What calib said of the capture: verdict, advice, and where it was seen and lit from.
#pragma once

#include <string>

#include "pipeline/report/report.h"

namespace glint {

// Outputs of calib whose names begin so, and the metric of that name without the underscore, are
// shown here and not in calib's own section.
inline constexpr char kGuidancePrefix[] = "guidance_";

// Empty where there is no calib, or one that says nothing (an imported set).
std::string GuidanceSection(const ReportInput& input);

}  // namespace glint
