// What a request's JSON holds. Throws HttpError 400 or 422 for what it should not hold.
#pragma once

#include <array>
#include <optional>
#include <string>

#include "base/files/json.h"
#include "pipeline/studio/http/http_types.h"

namespace glint {

Json JsonBody(HttpBody* body);  // an object

// Missing and null are `fallback`.
double NumberIn(const Json& json, const std::string& key, double fallback);
std::string TextIn(const Json& json, const std::string& key, const std::string& fallback);
std::optional<std::array<double, 2>> PairIn(const Json& json, const std::string& key);
bool FlagIn(const Json& json, const std::string& key);

}  // namespace glint
