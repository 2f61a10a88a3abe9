// What the page shows of each photograph: how far its rendering is from it, and their pictures.
#pragma once

#include <string>
#include <vector>

#include "datasets/looks/looks.h"
#include "datasets/looks/view_error.h"
#include "pipeline/report/report.h"

namespace glint {

struct ShownView {
  ViewError error;
  Looks looks;
  std::string photograph_uri;  // JPEG, for the viewer
  std::string cells;           // of a table: photograph, rendering, four times their difference
};

// In the set's order. Each photograph is read and rendered once, at the size of `input.shown`; at
// most kViewsAtOnce are in memory, some 280 MB each, whatever the number of threads. The same for
// any number of threads.
inline constexpr int kViewsAtOnce = 2;
std::vector<ShownView> ShowViews(const ReportInput& input, const ReportOptions& options,
                                 int threads);

}  // namespace glint
