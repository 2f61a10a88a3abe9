// Links to what `glint export` wrote.
#pragma once

#include <string>

#include "pipeline/report/report.h"

namespace glint {

// What the material is called: its exported name, otherwise its folder's.
std::string MaterialName(const ReportInput& input);

// The material files and maps of glint/export, each a link that downloads it; "" where the shown
// maps were not exported.
std::string DownloadsSection(const ReportInput& input, const ReportOptions& options);

}  // namespace glint
