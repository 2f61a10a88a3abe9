// /api/captures: one capture, what is in it, and what is done with it.
#pragma once

#include <string>

#include "pipeline/studio/routes/route_context.h"

namespace glint {

// `at` is the path after /api, "captures" first; `door` is the one through which the request came.
HttpReply RouteCaptures(const RouteContext& context, const Door& door, const Segments& at,
                        const std::string& method, HttpBody* body);

HttpReply SendThumbnail(const RouteContext& context, const LibraryEntry& entry,
                        const std::string& photo);

}  // namespace glint
