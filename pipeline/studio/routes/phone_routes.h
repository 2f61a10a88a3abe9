// /p/TOKEN: one capture for a phone, and nothing else of it than its photographs.
#pragma once

#include "pipeline/studio/routes/route_context.h"

namespace glint {

// `at` is the whole path, "p" first.
HttpReply RoutePhone(const RouteContext& context, const Segments& at, const HttpRequest& request,
                     HttpBody* body);

// {url, qr_svg, expires_s}
Json PhoneLinkJson(const PhoneLink& link, const Door& lan);

}  // namespace glint
