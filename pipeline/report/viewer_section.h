// The page's viewer: the material relit and, photograph by photograph, compared with what the
// camera saw (pipeline/viewer).
#pragma once

#include <string>
#include <vector>

#include "pipeline/report/report.h"
#include "pipeline/report/shown_views.h"

namespace glint {

// Its place in the page, with the maps and photographs that it shows inside. Where the build has no
// viewer: a note that says so.
std::string ViewerSection(const ReportInput& input, const ReportOptions& options,
                          const std::vector<ShownView>& shown, int threads);
// What the end of the page runs; nothing where the build has no viewer.
std::string ViewerScript();

}  // namespace glint
