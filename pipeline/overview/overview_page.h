// One page about many captures: those that failed first, each with a picture, the verdict on its
// photographs, key figures and a link to its own page. One file, nothing is loaded; sorted by any
// column with a script, and readable without.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "pipeline/overview/capture_summary.h"

namespace glint {

// `page`: where the page will lie; links are relative to its folder.
std::string OverviewPage(std::vector<CaptureSummary> captures, const std::filesystem::path& page);

}  // namespace glint
