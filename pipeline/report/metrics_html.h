// The metrics of any stage as figures, charts and tables, whatever their names.
#pragma once

#include <string>

#include "base/files/json.h"
#include "pipeline/report/figure.h"

namespace glint {

// Numbers and texts become one table; lists of three and more numbers charts; lists of objects
// tables, or charts when they are long; objects are gone into.
std::string MetricsHtml(const Json& metrics, const Trace& trace);

// A two-column table of an object's values.
std::string PairsTable(const Json& object, const Trace& trace);

// A table with a row an object and a column a key; nested lists are left to charts.
std::string ObjectsTable(const Json& list, const Trace& trace);

}  // namespace glint
