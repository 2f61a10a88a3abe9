// /files/SECRET/ID/NAME: a result's files. The report runs as a page of nowhere, which has no
// cookie, so that the secret stands in the address.
#pragma once

#include <string>

#include "pipeline/studio/routes/route_context.h"

namespace glint {

// `at` is the whole path, "files" first. `is_report`: a page with scripts of its own.
HttpReply RouteResult(const RouteContext& context, const Segments& at, bool* is_report);

// What stands before NAME.
std::string AddressOfFiles(const RouteContext& context, const LibraryEntry& entry);

}  // namespace glint
