// What changes, for a page that listens.
#pragma once

#include <functional>
#include <string>

#include "pipeline/studio/http/http_types.h"
#include "pipeline/studio/workspace/events.h"

namespace glint {

// Of the capture `only` (empty: all), until `may_listen` says no.
HttpReply EventStream(EventHub* events, const std::string& only,
                      const std::function<bool()>& may_listen);

}  // namespace glint
