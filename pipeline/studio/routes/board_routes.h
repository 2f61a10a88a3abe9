// /api/boards: boards to choose from, printed, described and measured.
#pragma once

#include <string>

#include "pipeline/studio/routes/route_context.h"

namespace glint {

// `at` is the path after /api, "boards" first.
HttpReply RouteBoards(const RouteContext& context, const Segments& at, const std::string& method,
                      HttpBody* body);

}  // namespace glint
