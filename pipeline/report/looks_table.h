// How renderings look beside their photographs (datasets/looks/looks_figures.h), on the page.
#pragma once

#include <string>

#include "base/files/json.h"
#include "pipeline/report/figure.h"

namespace glint {

// Every figure, as cells of a table's head and of a row. `figures` holds what ToJson(Looks) has;
// `trace`: where it is in a manifest.
std::string LooksHeadCells();
std::string LooksCells(const Json& figures, const Trace& trace);

// The means of fitted and of held-out photographs, and what each figure says; "" where there are
// none. `note`: what else to say of them.
std::string LooksTable(const Json& own_metrics, const Trace& own, const std::string& note);

}  // namespace glint
